#include "io/deflate.h"

#include <zlib.h>

#include <new>

#include "base/assert.h"

namespace tailwater {

std::string deflated(std::string_view raw, int level) {
  uLongf size = compressBound(raw.size());
  std::string bytes(size, '\0');
  const int status = compress2(reinterpret_cast<Bytef*>(bytes.data()), &size,
                               reinterpret_cast<const Bytef*>(raw.data()), raw.size(), level);
  if (status == Z_MEM_ERROR) throw std::bad_alloc();
  TAILWATER_ASSERT(status == Z_OK, "zlib accepts levels 0 to 9 and a buffer of compressBound bytes");
  bytes.resize(size);
  return bytes;
}

}  // namespace tailwater
