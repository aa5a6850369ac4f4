// Plans a tour of some regions and bounds it, for published.py:
//
//   vantage_published_tours INNER OUTER SECONDS GAP [CERTIFICATE]
//
// Files of regions are text: their number; for each the numbers of vertices and triangles, then these. Tours go through
// the inner ones, bounds are over the outer ones. Prints the
// tour's length, the bound, which bound it is, and seconds.
#include <algorithm>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <iostream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "core/stopwatch.h"
#include "flight/tour/tour_bound.h"
#include "flight/tour/tour_certificate.h"
#include "vantage/tour.h"

namespace {

namespace tour = vantage::internal::flight::tour;

constexpr double kShareOfTour = 0.4;  // of the time, at most

std::vector<vantage::Mesh> read(const char* path) {
  std::ifstream in(path);
  std::size_t count = 0;
  in >> count;
  std::vector<vantage::Mesh> meshes(count);
  for (vantage::Mesh& mesh : meshes) {
    std::size_t vertices = 0, triangles = 0;
    in >> vertices >> triangles;
    mesh.vertices.resize(vertices);
    mesh.triangles.resize(triangles);
    for (vantage::Vec3& v : mesh.vertices) in >> v[0] >> v[1] >> v[2];
    for (vantage::Triangle& t : mesh.triangles) in >> t[0] >> t[1] >> t[2];
  }
  if (!in) throw std::runtime_error(std::string(path) + ": cut short");
  return meshes;
}

vantage::Tour planned(const std::vector<vantage::Mesh>& inner, double seconds) {
  vantage::TourRequest request;
  request.settings.dwell_s = request.settings.margin_m = request.settings.clearance_m = 0;
  request.settings.simultaneous = true;
  request.settings.time_limit_s = seconds;
  for (std::size_t i = 0; i < inner.size(); ++i) request.targets.push_back({std::to_string(i), inner[i], {}});
  return vantage::plan_tour(request);
}

void run(const char* inner_file, const char* outer_file, double seconds, double gap, const char* certificate) {
  const vantage::internal::core::Stopwatch watch;
  const vantage::Tour flown = planned(read(inner_file), kShareOfTour * seconds);
  if (!flown.problems.empty()) throw std::runtime_error("a region was left out");
  tour::BoundProblem problem;
  for (vantage::Mesh& mesh : read(outer_file)) {
    problem.regions.push_back(tour::OuterRegion::given(std::move(mesh), std::to_string(problem.regions.size())));
  }
  tour::Incumbent incumbent;
  incumbent.length_m = flown.length_m;
  for (const vantage::TourVisit& visit : flown.visits) {
    incumbent.order.push_back(visit.target);
    incumbent.points.push_back(flown.flight.points[visit.first_point].position);
  }
  const double planned_s = watch.seconds();
  tour::BoundOptions options;
  options.gap = gap;
  options.threads = 1;
  options.time_limit_s = std::max(1.0, seconds - planned_s);
  const tour::TourBound bound = tour::bound_tour(problem, incumbent, options);
  std::cout.precision(12);
  std::cout << flown.length_m << " " << bound.length_m << " " << name_of(bound.kind) << " " << watch.seconds() << "\n";
  if (certificate != nullptr) tour::write_tour_certificate(bound, certificate);
}

}  // namespace

int main(int count, char** words) {
  if (count < 5) {
    std::cerr << "usage: vantage_published_tours INNER OUTER SECONDS GAP [CERTIFICATE]\n";
    return 2;
  }
  try {
    run(words[1], words[2], std::atof(words[3]), std::atof(words[4]), count > 5 ? words[5] : nullptr);
  } catch (const std::exception& error) {
    std::cerr << error.what() << "\n";
    return 1;
  }
  return 0;
}
