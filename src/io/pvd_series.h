// The field files of a run and a list of them with their times (ParaView's .pvd). The whole list is rewritten after
// every file, so a killed run leaves a series that opens.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "io/vtp_writer.h"

namespace tailwater {

class PvdSeries {
 public:
  /// Files FOLDER/NAME_00000.vtp, ... listed in FOLDER/NAME.pvd; zlib level `compression`, 0 to 9.
  PvdSeries(std::filesystem::path folder, std::string name, int compression = usual_compression);

  /// Adds the fields at `time` [s]; each rank gives its own particles. Collective. Throws IoError, on all ranks.
  template <int Dim>
  void write(double time, const ParticleFields<Dim>& particles, const Communicator& ranks = {});

  /// Continues the series after the files that an earlier run has written at `times`, and removes later files.
  /// Collective. Throws IoError, on all ranks.
  void go_on(std::vector<double> times, const Communicator& ranks = {});

  /// Number of files written.
  std::size_t size() const { return times_.size(); }
  /// Times of the files [s].
  const std::vector<double>& times() const { return times_; }

 private:
  std::filesystem::path file_of(std::size_t index) const { return folder_ / file_name(index); }
  std::string file_name(std::size_t index) const;
  void write_list() const;

  std::filesystem::path folder_;
  std::string name_;
  int compression_;
  std::vector<double> times_;
};

}  // namespace tailwater
