// Meshes made by the tests, and the files they are written to.
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <string>
#include <vector>

#include "geometry/cases.h"
#include "geometry/triangle_mesh.h"

namespace tailwater::testing_cases {

inline void add_quad(TriangleMesh& mesh, int a, int b, int c, int d) {
  mesh.triangles.push_back({a, b, c});
  mesh.triangles.push_back({a, c, d});
}

/// A box, its front outside.
inline TriangleMesh box_mesh(const Vec<3>& low, const Vec<3>& high) {
  TriangleMesh mesh;
  for (int k = 0; k < 8; ++k) {
    mesh.points.emplace_back(k & 1 ? high[0] : low[0], k & 2 ? high[1] : low[1], k & 4 ? high[2] : low[2]);
  }
  add_quad(mesh, 0, 2, 3, 1);
  add_quad(mesh, 4, 5, 7, 6);
  add_quad(mesh, 0, 1, 5, 4);
  add_quad(mesh, 2, 6, 7, 3);
  add_quad(mesh, 0, 4, 6, 2);
  add_quad(mesh, 1, 3, 7, 5);
  return mesh;
}

inline TriangleMesh unit_box() { return box_mesh(Vec<3>::Zero(), Vec<3>::Ones()); }

/// A sphere of rings between two poles, its front outside; `rings` times 2 `rings` pieces.
inline TriangleMesh sphere_mesh(const Vec<3>& centre, double radius, int rings) {
  TriangleMesh mesh;
  mesh.points.push_back(centre - radius * Vec<3>::UnitZ());
  for (int r = 1; r < rings; ++r) {
    const double polar = std::numbers::pi * r / rings;
    for (int k = 0; k < 2 * rings; ++k) {
      const double around = std::numbers::pi * k / rings;
      mesh.points.push_back(centre + radius * Vec<3>(std::sin(polar) * std::cos(around),
                                                     std::sin(polar) * std::sin(around), -std::cos(polar)));
    }
  }
  mesh.points.push_back(centre + radius * Vec<3>::UnitZ());
  const int top = static_cast<int>(mesh.points.size()) - 1;
  const auto at = [&](int r, int k) { return 1 + (r - 1) * 2 * rings + k % (2 * rings); };
  for (int k = 0; k < 2 * rings; ++k) {
    mesh.triangles.push_back({0, at(1, k + 1), at(1, k)});
    mesh.triangles.push_back({top, at(rings - 1, k), at(rings - 1, k + 1)});
    for (int r = 1; r + 1 < rings; ++r) add_quad(mesh, at(r, k), at(r, k + 1), at(r + 1, k + 1), at(r + 1, k));
  }
  return mesh;
}

/// A sheet over [0, 1] x [0, 1], its front up: z = height(x, y) at `cells` times `cells` pieces.
template <class Height>
TriangleMesh sheet_mesh(int cells, Height&& height) {
  TriangleMesh mesh;
  for (int j = 0; j <= cells; ++j) {
    for (int i = 0; i <= cells; ++i) {
      const double x = static_cast<double>(i) / cells;
      const double y = static_cast<double>(j) / cells;
      mesh.points.emplace_back(x, y, height(x, y));
    }
  }
  const auto at = [&](int i, int j) { return j * (cells + 1) + i; };
  for (int j = 0; j < cells; ++j) {
    for (int i = 0; i < cells; ++i) add_quad(mesh, at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
  }
  return mesh;
}

inline double volume_of(const TriangleMesh& mesh) {
  return six_volumes(mesh, [](int) { return true; }) / 6.0;
}

inline std::string ascii_stl(const TriangleMesh& mesh) {
  std::string text = "solid test\n";
  for (int t = 0; t < static_cast<int>(mesh.triangles.size()); ++t) {
    text += "facet normal 0 0 0\nouter loop\n";
    for (int c = 0; c < 3; ++c) {
      const Vec<3>& x = mesh.corner(t, c);
      text += fmt::format("vertex {:.9g} {:.9g} {:.9g}\n", x[0], x[1], x[2]);
    }
    text += "endloop\nendfacet\n";
  }
  return text + "endsolid test\n";
}

inline std::string binary_stl(const TriangleMesh& mesh) {
  std::string bytes(80, ' ');
  const auto put = [&](auto value) {
    char raw[sizeof(value)];
    std::memcpy(raw, &value, sizeof(value));
    bytes.append(raw, sizeof(value));
  };
  put(static_cast<std::uint32_t>(mesh.triangles.size()));
  for (int t = 0; t < static_cast<int>(mesh.triangles.size()); ++t) {
    for (int k = 0; k < 3; ++k) put(0.0F);
    for (int c = 0; c < 3; ++c) {
      for (int axis = 0; axis < 3; ++axis) put(static_cast<float>(mesh.corner(t, c)[axis]));
    }
    put(std::uint16_t{0});
  }
  return bytes;
}

inline std::string obj(const TriangleMesh& mesh) {
  std::string text = "# made by a test\n";
  for (const Vec<3>& x : mesh.points) text += fmt::format("v {:.9g} {:.9g} {:.9g}\n", x[0], x[1], x[2]);
  for (const auto& t : mesh.triangles) text += fmt::format("f {} {} {}\n", t[0] + 1, t[1] + 1, t[2] + 1);
  return text;
}

inline std::string ply(const TriangleMesh& mesh) {
  std::string text = fmt::format(
      "ply\nformat ascii 1.0\nelement vertex {}\nproperty float x\nproperty float y\nproperty float z\nelement face "
      "{}\nproperty list uchar int vertex_indices\nend_header\n",
      mesh.points.size(), mesh.triangles.size());
  for (const Vec<3>& x : mesh.points) text += fmt::format("{:.9g} {:.9g} {:.9g}\n", x[0], x[1], x[2]);
  for (const auto& t : mesh.triangles) text += fmt::format("3 {} {} {}\n", t[0], t[1], t[2]);
  return text;
}

/// A folder that lives as long as a test.
class MeshFolder {
 public:
  MeshFolder() : path_(std::filesystem::temp_directory_path() / fmt::format("tailwater-mesh-{}", getpid())) {
    std::filesystem::create_directories(path_);
  }
  ~MeshFolder() { std::filesystem::remove_all(path_); }
  MeshFolder(const MeshFolder&) = delete;
  MeshFolder& operator=(const MeshFolder&) = delete;

  std::string write(const std::string& name, const std::string& bytes) const {
    std::ofstream(path_ / name, std::ios::binary) << bytes;
    return (path_ / name).string();
  }

  /// A wall of the mesh.
  WallTable wall(const TriangleMesh& mesh, FluidSide side) const {
    return wall_of_file(write("mesh.stl", binary_stl(mesh)), side);
  }

  static WallTable wall_of_file(const std::string& file, FluidSide side) {
    WallTable wall;
    wall.shape = WallShape::mesh;
    wall.file = file;
    wall.fluid_side = side;
    return wall;
  }

 private:
  std::filesystem::path path_;
};

/// Water around the origin, and a wall in it.
inline CaseSpec case_with(const WallTable& wall) {
  CaseSpec spec = empty_case(0.1, 3);
  spec.walls = {wall};
  spec.fluid = {box_fluid({-1.0, -1.0, -1.0}, {2.0, 2.0, 2.0})};
  return spec;
}

inline void expect_words(const std::string& message, const std::vector<std::string>& words) {
  for (const std::string& word : words) EXPECT_NE(message.find(word), std::string::npos) << message;
}

}  // namespace tailwater::testing_cases
