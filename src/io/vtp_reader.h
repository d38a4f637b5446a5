// Reads the VTP files that vtp_writer.h writes, also those of several ranks; no others.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace tailwater {

struct VtpFile {
  /// A field, or the points: all values of the first point, then of the next.
  struct Array {
    std::size_t components = 1;
    std::vector<double> values;
  };
  double time = 0.0;  ///< s
  std::size_t count = 0;
  Array points;  ///< m; three coordinates each
  std::map<std::string, Array> fields;
};

/// Reads the bytes of a file with the name `name` in messages. Throws IoError if it is incomplete.
VtpFile read_vtp_bytes(std::string_view bytes, const std::string& name);

/// Files and times [s] of a list that pvd_series.h has written. Throws IoError.
struct PvdEntry {
  double time;
  std::string file;  ///< name in the folder of the list
};
std::vector<PvdEntry> read_pvd(std::string_view bytes);

}  // namespace tailwater
