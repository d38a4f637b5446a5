// Candidates for the neighbours of a group of particles that search a grid together.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

#include "base/batch.h"
#include "base/vec.h"
#include "neighbours/cell_grid.h"
#include "neighbours/pairs.h"

namespace tailwater {

/// A grid, and the particles in it.
template <int Dim>
struct SearchedGrid {
  const CellGrid<Dim>* grid;
  const std::int32_t* order;     ///< particle indices cell by cell; may be read a batch beyond its end
  double largest_spacing = 1.0;  ///< of the particles, over that of the case
};

/// The grids of a set of particles: several where particles have several spacings.
template <int Dim>
struct SearchedSet {
  std::vector<SearchedGrid<Dim>> grids;
  bool holds_searchers;  ///< whether they also contain the particles that search them
};

/// Particles with consecutive indices that are near each other, so that they share their candidates.
template <int Dim>
struct Group {
  Group(std::span<const Vec<Dim>> position, std::size_t first)
      : begin(static_cast<std::int32_t>(first)), end(begin + 1), low(position[first]), high(low) {}

  /// Adds the next particle, unless the box would then be longer than `max_extent` [m].
  bool add(const Vec<Dim>& position, double max_extent) {
    const Vec<Dim> new_low = low.cwiseMin(position);
    const Vec<Dim> new_high = high.cwiseMax(position);
    if ((new_high - new_low).maxCoeff() > max_extent) return false;
    low = new_low;
    high = new_high;
    ++end;
    return true;
  }

  /// m^2; from the box to a place.
  double squared_distance(const Vec<Dim>& position) const {
    return (position - position.cwiseMax(low).cwiseMin(high)).squaredNorm();
  }

  std::int32_t begin;
  std::int32_t end;
  Vec<Dim> low;  ///< m; of the box around the particles
  Vec<Dim> high;
  double largest_spacing = 1.0;  ///< of the particles, over that of the case
};

/// List of particle indices, written a batch at a time. A batch beyond the end can be read, and holds valid indices.
class IndexList {
 public:
  void clear() { count_ = 0; }
  void make_room(std::size_t more) {
    if (count_ + more + batch_size > index_.size()) index_.resize(2 * (count_ + more + batch_size));
  }
  /// Adds the indices of a batch whose bit is set. The list must have space for a whole batch.
  void add(const std::int32_t* indices, unsigned bits) {
    count_ = write_chosen(indices, bits, index_.data() + count_) - index_.data();
  }
  /// Adds all of `indices`, of which a batch beyond the end is read.
  void add(std::span<const std::int32_t> indices) {
    make_room(indices.size());
    for (std::size_t n = 0; n < indices.size(); n += batch_size) {
      std::memcpy(index_.data() + count_ + n, indices.data() + n, batch_size * sizeof(std::int32_t));
    }
    count_ += indices.size();
  }
  /// Adds begin .. end.
  void add_range(std::int32_t begin, std::int32_t end) {
    make_room(end - begin);
    for (; begin < end; ++begin) index_[count_++] = begin;
  }
  template <class Condition>
  void remove_if(const Condition& condition) {
    count_ = std::remove_if(index_.begin(), index_.begin() + static_cast<std::ptrdiff_t>(count_), condition) -
             index_.begin();
  }

  std::size_t size() const { return count_; }
  const std::int32_t* data() const { return index_.data(); }

 private:
  std::vector<std::int32_t> index_ = std::vector<std::int32_t>(batch_size);
  std::size_t count_ = 0;
};

/// Candidates for the neighbours of a group, in the order of a row: indices below the group, the group, indices above
/// it, ghosts.
template <int Dim>
class CandidateIndices {
 public:
  void find(const SearchedSet<Dim>& searched, const Pairs<Dim>& pairs, const Group<Dim>& group) {
    const double radius = kernel_radius(pairs.kernel);
    bool has_large_cells = false;
    near_.clear();
    for (const SearchedGrid<Dim>& grid : searched.grids) {
      search(grid, 0.5 * (group.largest_spacing + grid.largest_spacing) * radius, group);
      has_large_cells = has_large_cells || grid.grid->reach() > 1.5 * grid.largest_spacing * radius;
    }
    sort(pairs, group);
    own_.clear();
    if (searched.holds_searchers) own_.add_range(group.begin, group.end);
    // If a distant particle enlarges the cells, most candidates are far away, some so far that integer places repeat.
    if (has_large_cells) remove_beyond(radius, pairs, group);
  }

  const IndexList& below() const { return below_; }  ///< owned, before the group
  const IndexList& own() const { return own_; }      ///< the group; empty if the grid does not contain it
  const IndexList& above() const { return above_; }  ///< owned, after the group
  const IndexList& ghosts() const { return ghosts_; }

 private:
  /// Copies the ranges of the grid into one list, because most of them are shorter than a batch.
  void search(const SearchedGrid<Dim>& searched, double reach, const Group<Dim>& group) {
    searched.grid->for_each_range_near(group.low, group.high, reach, [&](std::int32_t begin, std::int32_t end) {
      near_.add({searched.order + begin, searched.order + end});
    });
  }

  void sort(const Pairs<Dim>& pairs, const Group<Dim>& group) {
    const auto owned = static_cast<std::int32_t>(pairs.owned());
    const bool has_ghosts = pairs.owned() < pairs.place.size();
    for (IndexList* list : {&below_, &above_, &ghosts_}) {
      list->clear();
      list->make_room(near_.size());
    }
    for (std::size_t n = 0; n < near_.size(); n += batch_size) {
      const std::int32_t* const indices = near_.data() + n;
      const auto index = batch_at<IndexBatch>(indices);
      const unsigned all = first_bits(near_.size() - n);
      below_.add(indices, all & bits_of(index < group.begin));
      above_.add(indices, all & bits_of((index >= group.end) & (index < owned)));
      if (has_ghosts) ghosts_.add(indices, all & bits_of(index >= owned));
    }
  }

  void remove_beyond(double radius, const Pairs<Dim>& pairs, const Group<Dim>& group) {
    for (IndexList* list : {&below_, &above_, &ghosts_}) {
      list->remove_if([&](std::int32_t j) { return group.squared_distance(pairs.position[j]) > radius * radius; });
    }
  }

  IndexList near_;
  IndexList below_;
  IndexList own_;
  IndexList above_;
  IndexList ghosts_;
};

}  // namespace tailwater
