// Files of regions, for the benchmarks of tours: their number; for each the numbers of vertices and triangles, then
// these. Text, metres.
#pragma once

#include <cstddef>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "vantage/geometry.h"

namespace vantage::bench {

inline std::vector<Mesh> read_regions(const std::string& path) {
  std::ifstream in(path);
  std::size_t count = 0;
  in >> count;
  std::vector<Mesh> meshes(count);
  for (Mesh& mesh : meshes) {
    std::size_t vertices = 0, triangles = 0;
    in >> vertices >> triangles;
    mesh.vertices.resize(vertices);
    mesh.triangles.resize(triangles);
    for (Vec3& v : mesh.vertices) in >> v[0] >> v[1] >> v[2];
    for (Triangle& t : mesh.triangles) in >> t[0] >> t[1] >> t[2];
  }
  if (!in) throw std::runtime_error(path + ": cut short");
  return meshes;
}

inline void write_regions(const std::vector<Mesh>& meshes, const std::string& path) {
  std::ofstream out(path);
  out.precision(17);
  out << meshes.size() << "\n";
  for (const Mesh& mesh : meshes) {
    out << mesh.vertices.size() << " " << mesh.triangles.size() << "\n";
    for (const Vec3& v : mesh.vertices) out << v[0] << " " << v[1] << " " << v[2] << "\n";
    for (const Triangle& t : mesh.triangles) out << t[0] << " " << t[1] << " " << t[2] << "\n";
  }
  if (!out.flush()) throw std::runtime_error(path + ": cannot be written");
}

}  // namespace vantage::bench
