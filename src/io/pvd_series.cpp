#include "io/pvd_series.h"

#include <fmt/format.h>

#include <cerrno>
#include <iterator>
#include <utility>

#include "io/write_file.h"
#include "parallel/together.h"

namespace tailwater {

PvdSeries::PvdSeries(std::filesystem::path folder, std::string name, int compression)
    : folder_(std::move(folder)), name_(std::move(name)), compression_(compression) {}

template <int Dim>
void PvdSeries::write(double time, const ParticleFields<Dim>& particles, const Communicator& ranks) {
  write_vtp(file_of(times_.size()), time, encode_piece(particles, compression_), compression_, ranks);
  times_.push_back(time);
  do_on_root(ranks, [this] { write_list(); });
}

void PvdSeries::go_on(std::vector<double> times, const Communicator& ranks) {
  times_ = std::move(times);
  do_on_root(ranks, [this] {
    std::error_code error;
    for (std::size_t i = 0; i < times_.size(); ++i) {
      if (!std::filesystem::exists(file_of(i), error)) throw_io_error("read", file_of(i), ENOENT);
    }
    // The list is written first: it must never name a missing file.
    if (!times_.empty()) write_list();
    for (std::size_t i = times_.size(); std::filesystem::exists(file_of(i), error); ++i) remove_file(file_of(i));
  });
}

std::string PvdSeries::file_name(std::size_t index) const { return fmt::format("{}_{:05}.vtp", name_, index); }

void PvdSeries::write_list() const {
  std::string xml =
      "<?xml version=\"1.0\"?>\n"
      "<VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"LittleEndian\">\n"
      "  <Collection>\n";
  for (std::size_t i = 0; i < times_.size(); ++i) {
    fmt::format_to(std::back_inserter(xml), "    <DataSet timestep=\"{}\" file=\"{}\"/>\n", times_[i], file_name(i));
  }
  xml += "  </Collection>\n</VTKFile>\n";
  write_text_file(folder_ / (name_ + ".pvd"), xml);
}

template void PvdSeries::write<2>(double, const ParticleFields<2>&, const Communicator&);
template void PvdSeries::write<3>(double, const ParticleFields<3>&, const Communicator&);

}  // namespace tailwater
