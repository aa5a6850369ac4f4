// Tours of a fixed wing as the seed paper's group found them, for cities.py: poses sampled on the surfaces of the
// volumes, and the shortest tour of one pose of each (a generalised travelling salesman problem). Their solver is a
// heuristic; here it is exact, by dynamic programming over sets (M. Held and R. M. Karp, 1962), so that what is
// compared is the sampling alone.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <exception>
#include <iostream>
#include <limits>
#include <numbers>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/parallel.h"
#include "core/stopwatch.h"
#include "region_files.h"
#include "vantage/dubins.h"

namespace {

using vantage::SpacePose;
using vantage::Vec3;

constexpr double kNever = std::numeric_limits<double>::infinity();
constexpr double kDegree = std::numbers::pi / 180;

/// On faces, by area: `places` of them, each with headings spread evenly over the half turn about the inward normal.
std::vector<SpacePose> on_faces(const vantage::Mesh& mesh, int places, int headings, std::mt19937_64& engine) {
  std::vector<double> areas;
  for (const vantage::Triangle& t : mesh.triangles) {
    const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    areas.push_back((b - a).cross(c - a).norm());
  }
  std::discrete_distribution<std::size_t> face(areas.begin(), areas.end());
  std::uniform_real_distribution<> unit(0, 1);
  std::vector<SpacePose> poses;
  for (int i = 0; i < places; ++i) {
    const vantage::Triangle& t = mesh.triangles[face(engine)];
    const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    const double root = std::sqrt(unit(engine)), share = unit(engine);
    const Vec3 at = (1 - root) * a + root * (1 - share) * b + root * share * c;
    const Vec3 outward = (b - a).cross(c - a);
    const double inward = std::atan2(-outward.y(), -outward.x());
    for (int k = 0; k < headings; ++k) {
      const double turn = headings > 1 ? std::numbers::pi * (static_cast<double>(k) / (headings - 1) - 0.5) : 0;
      poses.push_back({at, inward + turn, 0});
    }
  }
  return poses;
}

/// Lengths between all poses of all regions; those of one region follow each other.
std::vector<std::vector<double>> lengths_of(const std::vector<SpacePose>& poses, std::size_t of_each,
                                            const vantage::WingLimits& limits) {
  std::vector<std::vector<double>> lengths(poses.size(), std::vector<double>(poses.size(), kNever));
  vantage::internal::parallel::for_ranges(poses.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      for (std::size_t j = 0; j < poses.size(); ++j) {
        if (i / of_each == j / of_each) continue;
        if (const auto path = vantage::dubins_airplane(poses[i], poses[j], limits)) lengths[i][j] = path->length_m();
      }
    }
  });
  return lengths;
}

/// From one pose of the last region round all others and back.
double round_from(std::size_t start, const std::vector<std::vector<double>>& lengths, std::size_t of_each) {
  const std::size_t others = lengths.size() / of_each - 1, nodes = others * of_each;
  std::vector<double> least((std::size_t{1} << others) * nodes, kNever);  // [set][last pose]
  for (std::size_t j = 0; j < nodes; ++j) {
    least[(std::size_t{1} << (j / of_each)) * nodes + j] = lengths[start][j];
  }
  for (std::size_t set = 1; set + 1 < std::size_t{1} << others; ++set) {
    for (std::size_t i = 0; i < nodes; ++i) {
      const double so_far = least[set * nodes + i];
      if (so_far == kNever) continue;
      for (std::size_t r = 0; r < others; ++r) {
        if ((set >> r & 1U) != 0) continue;
        double* const next = &least[(set | std::size_t{1} << r) * nodes];
        for (std::size_t j = r * of_each; j < (r + 1) * of_each; ++j) {
          next[j] = std::min(next[j], so_far + lengths[i][j]);
        }
      }
    }
  }
  double best = kNever;
  const double* const all = &least[((std::size_t{1} << others) - 1) * nodes];
  for (std::size_t j = 0; j < nodes; ++j) best = std::min(best, all[j] + lengths[j][start]);
  return best;
}

double shortest(const std::vector<std::vector<double>>& lengths, std::size_t of_each) {
  const std::size_t first = lengths.size() - of_each;
  std::vector<double> best(of_each, kNever);
  vantage::internal::parallel::for_ranges(of_each, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) best[k] = round_from(first + k, lengths, of_each);
  });
  return *std::min_element(best.begin(), best.end());
}

}  // namespace

int main(int count, char** words) {
  CLI::App app(
      "Tours of a fixed wing through poses sampled on faces, one of each region: a line of length and seconds "
      "for each seed.");
  std::string file;
  int seeds = 10, places = 8, headings = 4, threads = 2;
  double descent = -15, climb = 20;
  vantage::WingLimits limits;
  app.add_option("REGIONS", file)->required();
  app.add_option("--seeds", seeds, "1 to so many")->capture_default_str();
  app.add_option("--places", places, "on each region")->capture_default_str();
  app.add_option("--headings", headings, "at each place")->capture_default_str();
  app.add_option("--radius", limits.turn_radius_m, "m")->capture_default_str();
  app.add_option("--descent", descent, "degrees, negative")->capture_default_str();
  app.add_option("--climb", climb, "degrees")->capture_default_str();
  app.add_option("--threads", threads)->capture_default_str();
  CLI11_PARSE(app, count, words);
  limits.lowest_climb_rad = descent * kDegree;
  limits.highest_climb_rad = climb * kDegree;
  try {
    const std::vector<vantage::Mesh> regions = vantage::bench::read_regions(file);
    if (regions.size() < 2 || regions.size() > 12) throw std::runtime_error("2 to 12 regions, or it takes too long");
    vantage::internal::parallel::with_threads(threads, [&] {
      for (int seed = 1; seed <= seeds; ++seed) {
        const vantage::internal::core::Stopwatch watch;
        std::mt19937_64 engine(static_cast<std::uint64_t>(seed));
        std::vector<SpacePose> poses;
        for (const vantage::Mesh& mesh : regions) {
          for (const SpacePose& pose : on_faces(mesh, places, headings, engine)) poses.push_back(pose);
        }
        const std::size_t of_each = poses.size() / regions.size();
        const double length = shortest(lengths_of(poses, of_each, limits), of_each);
        std::cout << length << " " << watch.seconds() << std::endl;
      }
    });
  } catch (const std::exception& error) {
    std::cerr << error.what() << "\n";
    return 1;
  }
  return 0;
}
