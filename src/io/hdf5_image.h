// An HDF5 file as bytes in memory: datasets of numbers and texts by name. The functions for whole files write the bytes
// to disk and read them back. They report a full disk, and detect damage before the HDF5 library does.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tailwater {

class Hdf5Writer {
 public:
  /// `room`: bytes that are allocated for the file at once, and again whenever they are used up.
  explicit Hdf5Writer(std::size_t room = std::size_t{1} << 20);

  /// A dataset of one value per row or, with more columns, of a table; for double, int64, int32 and uint8.
  template <class Value>
  void put(const std::string& name, std::span<const Value> values, std::size_t columns = 1);
  void put(const std::string& name, std::string_view text);

  /// The whole file. The bytes belong to HDF5: they are freed with the writer and change with the next dataset.
  std::string_view image();

 private:
  std::shared_ptr<const std::int64_t> file_;
};

class Hdf5Reader {
 public:
  /// Copies the image. Throws IoError if it is not an HDF5 file.
  explicit Hdf5Reader(std::string_view image);

  /// All values of a dataset, row by row. Throws IoError if there is no dataset of this name and type.
  template <class Value>
  std::vector<Value> get(const std::string& name) const;
  std::string text(const std::string& name) const;

 private:
  std::size_t size_ = 0;  ///< bytes
  std::shared_ptr<const std::int64_t> file_;
};

}  // namespace tailwater
