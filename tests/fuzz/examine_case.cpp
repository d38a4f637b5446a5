#include "examine_case.h"

#include <algorithm>
#include <string>
#include <string_view>

#include "base/error.h"
#include "case/reader.h"
#include "checks/check.h"
#include "harness.h"
#include "run/run_case.h"
#include "sampling/particle_count.h"

namespace tailwater {
namespace {

/// Limit that keeps a check below a fraction of a second with sanitizers.
constexpr double max_particles = 2000.0;

template <int Dim>
Findings check_shapes(const CaseSpec& spec) {
  const Boundary<Dim> boundary = make_boundary<Dim>(spec);
  const ParticleCount count = expected_particle_count(spec, boundary);
  if (count.fluid + count.wall > max_particles) return {};
  return check_geometry(spec, boundary, make_fluid_particles(spec, boundary));
}

void require_places(std::string_view message, std::string_view file) {
  for (std::size_t begin = 0; begin <= message.size();) {
    const std::size_t end = std::min(message.find('\n', begin), message.size());
    if (!message.substr(begin, end - begin).starts_with(file)) finding("a message without a place", message);
    begin = end + 1;
  }
}

}  // namespace

void examine_case(const std::filesystem::path& file) {
  try {
    const CaseSpec spec = read_case(file);
    const Findings findings =
        with_places(spec, [&] { return spec.general.dimension == 2 ? check_shapes<2>(spec) : check_shapes<3>(spec); });
    for (const Finding& found : spec.sources.located(findings)) require_places(found.line(), file.string());
  } catch (const UserError& error) {
    require_places(error.what(), file.string());
  }
}

}  // namespace tailwater
