// What points see: inside or not, why not, and how much.
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/unique_ptr.h>
#include <nanobind/stl/vector.h>

#include <mutex>
#include <tuple>

#include "arrays.h"
#include "bindings.h"
#include "calls.h"
#include "mission.h"
#include "vantage/query.h"

namespace vantage::python {

using namespace nb::literals;

namespace {

/// Points per call into the engine: so often progress is told, and Ctrl-C heard.
constexpr std::size_t kPortion = 20'000;

/// Answers for one mission of one volume. One caller at a time; others wait.
class PyQuery {
 public:
  PyQuery(const PyMission& mission, const Progress& progress)
      : mission_(mission), query_(prepare_views(*mission, mission.prepared(progress)), mission->navigation, progress) {}

  std::vector<PointAnswer> answer(const std::vector<Vec3>& points, const Progress& progress) {
    const std::lock_guard lock(mutex_);
    std::vector<PointAnswer> answers;
    for_portions(points, progress, [&](std::span<const Vec3> portion) {
      for (PointAnswer& one : query_.answer(portion)) answers.push_back(std::move(one));
    });
    return answers;
  }

  std::vector<PointFraction> fractions(const std::vector<Vec3>& points, const FractionOptions& options,
                                       const Progress& progress) {
    PointQuery* const single = query_.single();
    if (!single) {
      throw Error(ErrorCode::not_applicable, "the share seen is that of one target, and the mission has several", "",
                  "ask for each of the targets");
    }
    const std::lock_guard lock(mutex_);
    std::vector<PointFraction> answers;
    for_portions(points, progress, [&](std::span<const Vec3> portion) {
      for (PointFraction& one : single->fractions(portion, options)) {
        answers.push_back(std::move(one));
      }
    });
    return answers;
  }

 private:
  template <typename Ask>
  static void for_portions(const std::vector<Vec3>& points, const Progress& progress, const Ask& ask) {
    for (std::size_t done = 0; done < points.size(); done += kPortion) {
      if (!progress("points", static_cast<double>(done) / static_cast<double>(points.size()))) {
        throw Error(ErrorCode::cancelled, "cancelled", "", "");
      }
      ask(std::span(points).subspan(done, std::min(kPortion, points.size() - done)));
    }
  }

  PyMission mission_;
  ViewsQuery query_;
  std::mutex mutex_;
};

std::unique_ptr<PyQuery> make(const PyMission& mission, nb::object progress) {
  if (volume_count(*mission) != 1) {
    throw Error(ErrorCode::not_applicable, "the mission asks for a volume for each of its targets", "",
                "ask for one of them: mission.one(index)");
  }
  return computed(std::move(progress), 0,
                  [&](const Progress& told) { return std::make_unique<PyQuery>(mission, told); });
}

nb::dict answer(PyQuery& query, const PointArray& array, int threads, nb::object progress) {
  const std::vector<Vec3> points = points_of(array);
  const std::vector<PointAnswer> answers =
      computed(std::move(progress), threads, [&](const Progress& told) { return query.answer(points, told); });
  std::vector<std::uint8_t> inside, out_of_range, behind;
  std::vector<double> margins;
  nb::list blocked_by, outside_of;
  for (const PointAnswer& one : answers) {
    inside.push_back(one.inside);
    out_of_range.push_back(one.out_of_range);
    behind.push_back(one.behind_target);
    margins.push_back(one.margin_m);
    blocked_by.append(one.blocked_by);
    outside_of.append(one.outside_of);
  }
  nb::dict columns;
  columns["inside"] = nb::cast(array_of(std::move(inside)));
  columns["margin_m"] = nb::cast(array_of(std::move(margins)));
  columns["blocked_by"] = blocked_by;
  columns["out_of_range"] = nb::cast(array_of(std::move(out_of_range)));
  columns["behind_target"] = nb::cast(array_of(std::move(behind)));
  columns["outside_of"] = outside_of;
  return columns;
}

using Ring = std::vector<std::vector<double>>;

Ring ring_of(const std::vector<Vec3>& corners) {
  Ring ring;
  for (const Vec3& corner : corners) ring.push_back(list_of(corner));
  return ring;
}

/// The shares, and with `polygons` for each point a list of polygons, each a list of rings.
std::tuple<ListView<double>, nb::list> fractions(PyQuery& query, const PointArray& array, const std::string& measure,
                                                 bool polygons, int threads, nb::object progress) {
  const auto by = fraction_measure(measure);
  if (!by) {
    throw Error(ErrorCode::unknown_choice, "there is no measure '" + measure + "'", "measure",
                "choose 'area', 'solid_angle' or 'pixels'");
  }
  const std::vector<Vec3> points = points_of(array);
  const std::vector<PointFraction> answers = computed(std::move(progress), threads, [&](const Progress& told) {
    return query.fractions(points, {*by, polygons}, told);
  });
  std::vector<double> shares;
  nb::list seen;
  for (const PointFraction& one : answers) {
    shares.push_back(one.fraction);
    if (!polygons) continue;
    nb::list of_point;
    for (const SeenPolygon& polygon : one.seen) {
      std::vector<Ring> rings = {ring_of(polygon.outer)};
      for (const std::vector<Vec3>& hole : polygon.holes) rings.push_back(ring_of(hole));
      of_point.append(rings);
    }
    seen.append(of_point);
  }
  return {array_of(std::move(shares)), seen};
}

}  // namespace

void bind_points(nb::module_& module) {
  nb::class_<PyQuery>(module, "Query")
      .def("answer", &answer, "points"_a.noconvert(), "threads"_a = 0, "progress"_a = nb::none())
      .def("fractions", &fractions, "points"_a.noconvert(), "measure"_a = "area", "polygons"_a = false, "threads"_a = 0,
           "progress"_a = nb::none());
  module.def("query", &make, "mission"_a, "progress"_a = nb::none());
}

}  // namespace vantage::python
