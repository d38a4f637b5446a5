// Shapes and words of a picture in SVG, in pixels. y points down.
#pragma once

#include <fmt/format.h>

#include <iterator>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/vec.h"

namespace tailwater {

constexpr double font_size = 13.0;

inline std::string escaped(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (c == '&') {
      out += "&amp;";
    } else if (c == '<') {
      out += "&lt;";
    } else if (c == '>') {
      out += "&gt;";
    } else {
      out += c;
    }
  }
  return out;
}

/// The two coordinates in the picture.
template <class Point>
Vec<2> project(const Point& x) {
  return {x[0], x[x.size() - 1]};
}

/// Metres to pixels; y points down in SVG.
struct View {
  Vec<2> low, high;  ///< m
  double scale;      ///< px/m
  double left, top;  ///< px

  Vec<2> operator()(const Vec<2>& x) const { return {left + scale * (x[0] - low[0]), top + scale * (high[1] - x[1])}; }
  double right() const { return left + scale * (high[0] - low[0]); }
  double bottom() const { return top + scale * (high[1] - low[1]); }
};

/// A picture under construction.
class Svg {
 public:
  template <class... Arguments>
  void add(fmt::format_string<Arguments...> text, Arguments&&... arguments) {
    fmt::format_to(std::back_inserter(text_), text, std::forward<Arguments>(arguments)...);
    text_ += '\n';
  }
  void text(double x, double y, std::string_view anchor, std::string_view words, double size = font_size) {
    add(R"(<text x="{:.1f}" y="{:.1f}" text-anchor="{}" font-size="{}">{}</text>)", x, y, anchor, size, escaped(words));
  }
  void line(const Vec<2>& from, const Vec<2>& to, std::string_view colour, double width) {
    add(R"(<line x1="{:.2f}" y1="{:.2f}" x2="{:.2f}" y2="{:.2f}" stroke="{}" stroke-width="{}"/>)", from[0], from[1],
        to[0], to[1], colour, width);
  }
  void outline(const std::vector<Vec<2>>& corners, std::string_view fill, std::string_view stroke) {
    std::string points;
    for (const Vec<2>& corner : corners)
      fmt::format_to(std::back_inserter(points), "{:.2f},{:.2f} ", corner[0], corner[1]);
    add(R"(<polygon points="{}" fill="{}" fill-opacity="0.35" stroke="{}"/>)", points, fill, stroke);
  }
  /// Round dots in one path: segments of length 0 with round caps.
  template <int Dim>
  void dots(const std::vector<Vec<Dim>>& points, const View& view, std::string_view colour, double diameter) {
    std::string path;
    for (const Vec<Dim>& x : points) {
      const Vec<2> p = view(project(x));
      fmt::format_to(std::back_inserter(path), "M{:.2f} {:.2f}h0", p[0], p[1]);
    }
    add(R"(<path d="{}" stroke="{}" stroke-width="{:.3f}" stroke-linecap="round" fill="none"/>)", path, colour,
        diameter);
  }
  const std::string& str() const { return text_; }

 private:
  std::string text_;
};

}  // namespace tailwater
