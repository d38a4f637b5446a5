#include "parts/section_counters.h"

#include <nlohmann/json.hpp>

#include "base/for_each.h"
#include "case/choices.h"
#include "case/spec.h"
#include "flow/flow.h"
#include "neighbours/halo.h"

namespace tailwater {
namespace {

/// 1 if the way from `start` to `end` leads through the section in its direction, -1 if it leads back, else 0.
template <int Dim>
double way_through(const Opening<Dim>& section, const Vec<Dim>& start, const Vec<Dim>& end) {
  const double before = section.beyond(start);
  const double after = section.beyond(end);
  if ((before > 0.0) == (after > 0.0)) return 0.0;
  if (!section.spans(start + before / (before - after) * (end - start))) return 0.0;
  return after > 0.0 ? 1.0 : -1.0;
}

/// The sum over the images of the way: water that leaves a periodic domain at one end passes the sections at the other.
template <int Dim>
double passes(const Opening<Dim>& section, std::span<const Vec<Dim>> shifts, const Vec<Dim>& start,
              const Vec<Dim>& end) {
  double sum = 0.0;
  for (const Vec<Dim>& shift : shifts) sum += way_through<Dim>(section, start + shift, end + shift);
  return sum;
}

}  // namespace

template <int Dim>
Json SectionCounters<Dim>::save() const {
  return volumes_;
}

template <int Dim>
bool SectionCounters<Dim>::restore(const Json& saved) {
  saved.get_to(volumes_);
  return volumes_.size() == sections_.size();
}

template <int Dim>
void SectionCounters<Dim>::follow_moved_water(const Flow<Dim>& flow, std::span<const MovedWater<Dim>> moved) {
  const std::vector<Vec<Dim>> shifts = image_shifts<Dim>(flow.setup.domain);
  for (std::size_t s = 0; s < sections_.size(); ++s) {
    const double volume = sum_over(moved.size(), 0.0, [&](std::size_t n) {
      return moved[n].volume * passes<Dim>(sections_[s], shifts, moved[n].from, moved[n].to);
    });
    volumes_[s] += flow.setup.ranks.sum(volume);
  }
}

template <int Dim>
void SectionCounters<Dim>::finish_step(Flow<Dim>& flow, const StepStart<Dim>& start, double /*dt*/) {
  const Particles<Dim>& particles = flow.state.particles;
  const std::vector<Vec<Dim>> shifts = image_shifts<Dim>(flow.setup.domain);
  for (std::size_t s = 0; s < sections_.size(); ++s) {
    const double volume = sum_over(particles.owned, 0.0, [&](std::size_t i) {
      if (!particles.is_fluid(i)) return 0.0;
      return passes<Dim>(sections_[s], shifts, start.position[i], particles.position[i]) * flow.water_volume_of(i);
    });
    volumes_[s] += flow.setup.ranks.sum(volume);
  }
}

template <int Dim>
void SectionCounters<Dim>::add_to_summary(const Flow<Dim>& flow, Json& summary) const {
  const double time = flow.state.time;
  for (std::size_t s = 0; s < sections_.size(); ++s) {
    summary["discharge"].push_back({{"name", sections_[s].name},
                                    {"volume_m3", volumes_[s]},
                                    {"mean_m3_per_s", time > 0.0 ? volumes_[s] / time : 0.0}});
  }
}

template <int Dim>
std::unique_ptr<Part<Dim>> make_section_counters(const CaseSpec& spec, const Setup<Dim>& /*setup*/,
                                                 const Boundary<Dim>& /*boundary*/) {
  std::vector<Opening<Dim>> sections;
  for (const ProbeTable& probe : spec.probes) {
    if (probe.type == ProbeType::discharge) sections.push_back(make_section<Dim>(probe, spec.particles.spacing));
  }
  if (sections.empty()) return nullptr;
  return std::make_unique<SectionCounters<Dim>>(std::move(sections));
}

template class SectionCounters<2>;
template class SectionCounters<3>;
TAILWATER_IN_2D_AND_3D(make_section_counters);

}  // namespace tailwater
