// Wrong flights made small, and written.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "flights.h"
#include "isolated.h"
#include "limit_attack.h"
#include "vantage/error.h"

namespace attack {
namespace {

using vantage::Vec3;

class FlightMinimiser {
 public:
  FlightMinimiser(DrawnFlight drawn, const std::string& wrong, const CheckFlight& check)
      : drawn_(std::move(drawn)), kind_(wrong.substr(0, wrong.find(':') + 1)), check_(check) {}

  DrawnFlight run() {
    drop_points();
    drop_triangles();
    drop_limits();
    return drawn_;
  }

 private:
  bool is_wrong(const DrawnFlight& tried) const {
    const Exit exit = run_isolated(60, [&] {
      const FlightJudgement judgement = judge_flight(tried, check_);
      const bool found = std::any_of(judgement.wrong.begin(), judgement.wrong.end(),
                                     [&](const std::string& wrong) { return wrong.starts_with(kind_); });
      return std::string(found ? "wrong" : "right");
    });
    return exit.text == "wrong";
  }
  bool take(DrawnFlight tried) {
    if (!is_wrong(tried)) return false;
    drawn_ = std::move(tried);
    return true;
  }

  void drop_points() {
    for (std::size_t i = drawn_.flight.points.size(); i-- > 0 && drawn_.flight.points.size() > 1;) {
      DrawnFlight tried = drawn_;
      tried.flight.points.erase(tried.flight.points.begin() + static_cast<std::ptrdiff_t>(i));
      take(std::move(tried));
    }
  }

  void drop_triangles() {
    for (std::size_t size = drawn_.mission.scene().mesh.triangles.size(); size > 0; size /= 2) {
      for (std::size_t begin = 0; begin < drawn_.mission.scene().mesh.triangles.size();) {
        DrawnFlight tried = drawn_;
        auto loaded = std::make_shared<vantage::LoadedScene>(*drawn_.mission.loaded);
        vantage::Scene& scene = loaded->scene;
        const auto first = static_cast<std::ptrdiff_t>(begin);
        const auto last = static_cast<std::ptrdiff_t>(std::min(begin + size, scene.mesh.triangles.size()));
        scene.mesh.triangles.erase(scene.mesh.triangles.begin() + first, scene.mesh.triangles.begin() + last);
        scene.object_of.erase(scene.object_of.begin() + first, scene.object_of.begin() + last);
        tried.mission.loaded = loaded;
        if (!take(std::move(tried))) begin += size;
      }
    }
  }

  template <typename Change>
  void try_without(const Change& change) {
    DrawnFlight tried = drawn_;
    change(tried);
    take(std::move(tried));
  }

  void drop_limits() {
    try_without([](DrawnFlight& d) { d.mission.navigation = {}; });
    try_without([](DrawnFlight& d) { d.options = {}; });
    try_without([](DrawnFlight& d) { d.options.tube_radius_m = d.flight.chord_error_m = 0; });
    try_without([](DrawnFlight& d) { d.mission.views.clear(); });
    every_limit([&](auto limit) {
      try_without([&](DrawnFlight& d) { leave_out<limit>(d.mission.navigation, d.mission.sensor); });
    });
    for (auto list : {&vantage::Navigation::keep_in, &vantage::Navigation::keep_out}) {
      for (std::size_t i = (drawn_.mission.navigation.*list).size(); i-- > 0;) {
        try_without([&](DrawnFlight& d) {
          auto& zones = d.mission.navigation.*list;
          zones.erase(zones.begin() + static_cast<std::ptrdiff_t>(i));
        });
      }
    }
  }

  DrawnFlight drawn_;
  std::string kind_;
  const CheckFlight& check_;
};

std::string numbers(const Vec3& p, const char* between) {
  char text[100];
  std::snprintf(text, sizeof text, "%.17g%s%.17g%s%.17g", p.x(), between, p.y(), between, p.z());
  return text;
}

void write_target(std::ostream& out, const vantage::Target& target) {
  for (const auto& part : target.parts) {
    out << "target part:";
    for (const Vec3& corner : part) out << " [" << numbers(corner, ", ") << "]";
    out << "\n";
  }
  out << "offset: " << target.offset_m << "\n";
  if (target.front) out << "front: " << numbers(*target.front, ", ") << "\n";
}

}  // namespace

DrawnFlight minimise_flight(const DrawnFlight& drawn, const std::string& wrong, const CheckFlight& check) {
  return FlightMinimiser(drawn, wrong, check).run();
}

void write_flight(const DrawnFlight& drawn, const std::string& wrong, const std::string& folder) {
  const std::filesystem::path place = folder;
  std::filesystem::create_directories(place);
  if (!drawn.mission.scene().mesh.empty()) write_scene(drawn.mission.scene(), place / "scene.obj");
  std::ofstream flight(place / "flight.csv");
  flight << "x,y,z,hold,speed\n";
  for (const vantage::FlightPoint& point : drawn.flight.points) {
    flight << numbers(point.position, ",") << "," << point.hold_s << ",";
    if (!std::isnan(point.speed_m_s)) flight << point.speed_m_s;
    flight << "\n";
  }
  std::ofstream note(place / "README.txt");
  note.precision(17);
  note << wrong << "\n" << drawn.kind << "\n";
  write_target(note, drawn.mission.target);
  for (const auto& list : drawn.mission.views) {
    note << "one of\n";
    for (const vantage::Target& target : list) write_target(note, target);
  }
  note << "tube: " << drawn.options.tube_radius_m << " + " << drawn.flight.chord_error_m << "\n";
  const vantage::Sensor& sensor = drawn.mission.sensor;
  const MissionLines lines = lines_of(drawn.mission.navigation, sensor);
  note << "sensor:\n  max_range: " << sensor.max_range_m << "\n" << lines.sensor;
  const bool is_face_on = sensor.pixel && sensor.pixel->kind == vantage::PixelLimit::Kind::perpendicular;
  if (is_face_on) note << "  pixel: {size: " << sensor.pixel->size_m << ", kind: perpendicular}\n";
  if (sensor.link) note << "link: " << sensor.link->frequency_ghz << ", " << sensor.link->clear << "\n";
  for (const vantage::FlightLink& link : drawn.mission.links) {
    note << "flight link: " << numbers(link.point, ", ");
    if (link.max_range_m) note << ", range " << *link.max_range_m;
    if (link.radio) note << ", radio " << link.radio->frequency_ghz << ", " << link.radio->clear;
    note << "\n";
  }
  note << "navigation:\n" << lines.navigation;
}

}  // namespace attack
