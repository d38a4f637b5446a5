#include "sampling/lattice_axis.h"

#include <algorithm>
#include <cmath>

namespace tailwater {
namespace {

/// Relative error of a distance: lengths written in decimals are whole numbers of spacings only up to round-off.
constexpr double round_off = 1e-9;

bool is_whole(double cells) {
  return std::abs(cells - std::round(cells)) <= round_off * std::max(1.0, std::abs(cells));
}

}  // namespace

LatticeAxis::LatticeAxis(std::vector<double> planes, double spacing) {
  std::ranges::sort(planes);
  std::vector<double> kept{planes.front()};
  for (const double plane : planes) {
    if (plane - kept.back() >= (1.0 - round_off) * spacing) kept.push_back(plane);
  }
  if (kept.size() == 1) {
    kept.push_back(planes.back());
  } else {
    kept.back() = planes.back();
  }
  const auto fits = [&](double plane) { return is_whole((plane - kept.front()) / spacing); };
  if (kept.back() - kept.front() >= 0.5 * spacing && std::ranges::all_of(kept, fits)) {
    pieces_.push_back(
        {kept.front(), spacing, 0, static_cast<int>(std::lround((kept.back() - kept.front()) / spacing))});
    return;
  }
  int first = 0;
  for (std::size_t k = 0; k + 1 < kept.size(); ++k) {
    const double length = kept[k + 1] - kept[k];
    const int cells = std::max(1, static_cast<int>(std::lround(length / spacing)));
    pieces_.push_back({kept[k], is_whole(length / spacing) ? spacing : length / cells, first, cells});
    first += cells;
  }
}

LatticeAxis LatticeAxis::divided(int parts) const {
  LatticeAxis finer = *this;
  for (Piece& piece : finer.pieces_) {
    piece = {piece.begin, piece.width / parts, piece.first * parts, piece.count * parts};
  }
  return finer;
}

const LatticeAxis::Piece& LatticeAxis::piece_of(int cell) const {
  const auto after = std::ranges::upper_bound(pieces_, cell, {}, &Piece::first);
  return after == pieces_.begin() ? pieces_.front() : *(after - 1);
}

int LatticeAxis::cell_at(double x) const {
  const auto after = std::ranges::upper_bound(pieces_, x, {}, &Piece::begin);
  const Piece& piece = after == pieces_.begin() ? pieces_.front() : *(after - 1);
  const int cell = piece.first + static_cast<int>(std::floor((x - piece.begin) / piece.width));
  // Round-off must not lead into the next piece.
  const bool is_last = &piece == &pieces_.back();
  return is_last ? cell : std::min(cell, piece.first + piece.count - 1);
}

}  // namespace tailwater
