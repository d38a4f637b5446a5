#include "io/hdf5_image.h"

#include <fmt/format.h>
#include <hdf5.h>

#include <array>
#include <new>
#include <type_traits>

#include "base/error.h"
#include "base/fp_traps.h"

namespace tailwater {
namespace {

static_assert(std::is_same_v<hid_t, std::int64_t>);

/// Position of the byte that marks a file as open for writing, in the default head of HDF5 files.
constexpr std::size_t place_of_open_flag = 20;

/// Owns an HDF5 identifier.
using Handle = std::shared_ptr<const hid_t>;

Handle own(hid_t id, herr_t (*close)(hid_t), std::string_view what) {
  if (id < 0) throw IoError("HDF5 cannot {}", what);
  return {new hid_t(id), [close](const hid_t* held) {
            close(*held);
            delete held;
          }};
}

void require_hdf5(herr_t status, std::string_view what) {
  if (status < 0) throw IoError("HDF5 cannot {}", what);
}

/// Turns off HDF5's own error output, because this program reports errors itself.
void begin_hdf5() {
  const SuspendFpTraps suspended;
  require_hdf5(H5open(), "start");
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

/// Access to a file in memory, which grows by `room` bytes at a time, and is never on disk.
Handle in_memory(std::size_t room) {
  const Handle access = own(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, "make a list of properties");
  require_hdf5(H5Pset_fapl_core(*access, room, false), "work in memory");
  require_hdf5(H5Pset_fclose_degree(*access, H5F_CLOSE_STRONG), "work in memory");
  return access;
}

/// A new name for each file, because HDF5 identifies files in memory by their names.
std::string new_name() {
  static int files = 0;
  return fmt::format("image {}", files++);
}

template <class Value>
hid_t type_of() {
  if constexpr (std::is_same_v<Value, double>) {
    return H5T_NATIVE_DOUBLE;
  } else if constexpr (std::is_same_v<Value, std::int64_t>) {
    return H5T_NATIVE_INT64;
  } else if constexpr (std::is_same_v<Value, std::int32_t>) {
    return H5T_NATIVE_INT32;
  } else {
    static_assert(std::is_same_v<Value, std::uint8_t>);
    return H5T_NATIVE_UINT8;
  }
}

}  // namespace

Hdf5Writer::Hdf5Writer(std::size_t room) {
  // HDF5 does not always test whether it got memory. Here a failed allocation is an exception.
  constexpr std::size_t own_room = std::size_t{16} << 20;
  ::operator delete(::operator new(room + own_room));
  begin_hdf5();
  file_ = own(H5Fcreate(new_name().c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, *in_memory(room)), H5Fclose,
              "make a file in memory");
}

template <class Value>
void Hdf5Writer::put(const std::string& name, std::span<const Value> values, std::size_t columns) {
  const SuspendFpTraps suspended;
  const std::string what = fmt::format("store '{}'", name);
  const std::array<hsize_t, 2> size{values.size() / columns, columns};
  const Handle space = own(H5Screate_simple(columns == 1 ? 1 : 2, size.data(), nullptr), H5Sclose, what);
  const Handle set =
      own(H5Dcreate2(*file_, name.c_str(), type_of<Value>(), *space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Dclose,
          what);
  if (values.empty()) return;
  require_hdf5(H5Dwrite(*set, type_of<Value>(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), what);
}

void Hdf5Writer::put(const std::string& name, std::string_view text) {
  put(name, std::span(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()));
}

std::string_view Hdf5Writer::image() {
  require_hdf5(H5Fflush(*file_, H5F_SCOPE_GLOBAL), "finish a file");
  const ssize_t size = H5Fget_file_image(*file_, nullptr, 0);
  void* held = nullptr;
  if (size < 0 || H5Fget_vfd_handle(*file_, H5P_DEFAULT, &held) < 0 || held == nullptr) {
    throw IoError("HDF5 cannot give the bytes of a file");
  }
  char* const bytes = *static_cast<char**>(held);
  bytes[place_of_open_flag] = 0;
  return {bytes, static_cast<std::size_t>(size)};
}

Hdf5Reader::Hdf5Reader(std::string_view image) {
  begin_hdf5();
  const SuspendFpTraps suspended;
  const Handle access = in_memory(image.size());
  // HDF5 copies the bytes, but its interface lacks a const.
  require_hdf5(H5Pset_file_image(*access, const_cast<char*>(image.data()), image.size()), "take the bytes of a file");
  size_ = image.size();
  file_ = own(H5Fopen(new_name().c_str(), H5F_ACC_RDONLY, *access), H5Fclose, "read it as one of its files");
}

template <class Value>
std::vector<Value> Hdf5Reader::get(const std::string& name) const {
  const SuspendFpTraps suspended;
  const std::string what = fmt::format("read '{}'", name);
  const Handle set = own(H5Dopen2(*file_, name.c_str(), H5P_DEFAULT), H5Dclose, what);
  const Handle type = own(H5Dget_type(*set), H5Tclose, what);
  const Handle space = own(H5Dget_space(*set), H5Sclose, what);
  const hssize_t count = H5Sget_simple_extent_npoints(*space);
  // The number of values in a damaged file may be wrong. Since values are not compressed, the file size limits it.
  const bool is_there = count >= 0 && static_cast<std::uint64_t>(count) <= size_ / sizeof(Value);
  if (!is_there || H5Tequal(*type, type_of<Value>()) <= 0) throw IoError("HDF5 cannot {}", what);
  std::vector<Value> values(static_cast<std::size_t>(count));
  if (count > 0) require_hdf5(H5Dread(*set, type_of<Value>(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), what);
  return values;
}

std::string Hdf5Reader::text(const std::string& name) const {
  const std::vector<std::uint8_t> bytes = get<std::uint8_t>(name);
  return {bytes.begin(), bytes.end()};
}

#define TAILWATER_INSTANTIATE(Value)                                                             \
  template void Hdf5Writer::put<Value>(const std::string&, std::span<const Value>, std::size_t); \
  template std::vector<Value> Hdf5Reader::get<Value>(const std::string&) const;
TAILWATER_INSTANTIATE(double)
TAILWATER_INSTANTIATE(std::int64_t)
TAILWATER_INSTANTIATE(std::int32_t)
TAILWATER_INSTANTIATE(std::uint8_t)
#undef TAILWATER_INSTANTIATE

}  // namespace tailwater
