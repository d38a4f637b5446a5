#include "io/deflate.h"

#include <libdeflate.h>

#include <memory>
#include <new>

#include "base/assert.h"

namespace tailwater {

std::string deflated(std::string_view raw, int level) {
  const std::unique_ptr<libdeflate_compressor, decltype(&libdeflate_free_compressor)> compressor(
      libdeflate_alloc_compressor(level), &libdeflate_free_compressor);
  if (compressor == nullptr) throw std::bad_alloc();
  std::string bytes(libdeflate_zlib_compress_bound(compressor.get(), raw.size()), '\0');
  bytes.resize(libdeflate_zlib_compress(compressor.get(), raw.data(), raw.size(), bytes.data(), bytes.size()));
  TAILWATER_ASSERT(!bytes.empty(), "a zlib stream has room within its bound");
  return bytes;
}

}  // namespace tailwater
