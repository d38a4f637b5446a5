#include "io/deflate.h"

#include <libdeflate.h>

#include <array>
#include <memory>
#include <new>

#include "base/assert.h"

namespace tailwater {
namespace {

struct Free {
  void operator()(libdeflate_compressor* compressor) const { libdeflate_free_compressor(compressor); }
};

/// Kept for the next call, because making one takes as long as deflating some 10 kB.
libdeflate_compressor* compressor_of(int level) {
  thread_local std::array<std::unique_ptr<libdeflate_compressor, Free>, 13> kept;
  auto& compressor = kept[static_cast<std::size_t>(level)];
  if (compressor == nullptr) compressor.reset(libdeflate_alloc_compressor(level));
  if (compressor == nullptr) throw std::bad_alloc();
  return compressor.get();
}

}  // namespace

std::string deflated(std::string_view raw, int level) {
  libdeflate_compressor* compressor = compressor_of(level);
  std::string bytes(libdeflate_zlib_compress_bound(compressor, raw.size()), '\0');
  bytes.resize(libdeflate_zlib_compress(compressor, raw.data(), raw.size(), bytes.data(), bytes.size()));
  TAILWATER_ASSERT(!bytes.empty(), "a zlib stream fits into its bound");
  return bytes;
}

}  // namespace tailwater
