#include "self_test.h"

#include <cmath>
#include <cstdio>
#include <functional>
#include <string>

#include "engine_calls.h"
#include "judge.h"
#include "random.h"
#include "separation.h"

namespace attack {
namespace {

using vantage::CauseKind;
using vantage::Mesh;
using vantage::Outcome;

int failures = 0;

void expect(bool holds, const std::string& what) {
  if (holds) return;
  ++failures;
  std::printf("self-test: %s\n", what.c_str());
}

// ---- signs ----

using Wide = __int128;

int sign_of(Wide value) { return value > 0 ? 1 : (value < 0 ? -1 : 0); }

/// Integers below 2^20 apart, so that the determinant fits; as doubles about a far origin they are exact.
void test_signs() {
  Random random(1);
  for (int round = 0; round < 20000; ++round) {
    const int reach = random.pick({1, 2, 5, 1 << 19});
    long p[4][3];
    Vec3 q[4];
    const double unit = random.pick({1.0, 0x1p-30, 0x1p+10}), origin = random.pick({0.0, 0x1p+25});
    for (int i = 0; i < 4; ++i) {
      for (int a = 0; a < 3; ++a) {
        p[i][a] = random.integer(-reach, reach);
        q[i][a] = origin * unit + unit * static_cast<double>(p[i][a]);
      }
    }
    const auto d = [&](int i, int a) { return static_cast<Wide>(p[i][a] - p[0][a]); };
    const Wide x = d(1, 1) * d(2, 2) - d(1, 2) * d(2, 1), y = d(1, 2) * d(2, 0) - d(1, 0) * d(2, 2),
               z = d(1, 0) * d(2, 1) - d(1, 1) * d(2, 0);
    expect(orientation(q[0], q[1], q[2], q[3]) == sign_of(x * d(3, 0) + y * d(3, 1) + z * d(3, 2)), "orientation");
    expect(collinear(q[0], q[1], q[2]) == (x == 0 && y == 0 && z == 0), "collinear");
    const Wide square = d(1, 0) * d(1, 0) + d(1, 1) * d(1, 1) + d(1, 2) * d(1, 2);
    const long length = random.integer(0, 2 * reach);
    expect(compare_distance(q[0], q[1], unit * static_cast<double>(length)) ==
               sign_of(square - static_cast<Wide>(length) * length),
           "compare_distance");
  }
  // Off a plane by the last bit of one coordinate.
  const Vec3 a(5e6, 5e5, 0.1), b(5e6 + 3, 5e5, 0.1), c(5e6, 5e5 + 7, 0.1);
  expect(orientation(a, b, c, Vec3(5e6 + 1, 5e5 + 1, std::nextafter(0.1, 1))) == 1, "the last bit");
  expect(orientation(a, b, c, Vec3(5e6 + 1, 5e5 + 1, std::nextafter(0.1, 0))) == -1, "the last bit, below");
}

void test_separation() {
  const std::array<Vec3, 4> pyramid{Vec3(0, 0, 1), Vec3(-1, -1, 0), Vec3(1, -1, 0), Vec3(0, 2, 0)};
  const auto misses = [&](const Vec3& a, const Vec3& b, const Vec3& c) { return interior_misses(pyramid, {a, b, c}); };
  expect(misses({-1, -1, 0}, {1, -1, 0}, {0, 2, 0}), "a triangle that is a face");
  expect(misses({-1, -1, 0}, {1, -1, 0}, {0, -5, 3}), "one that stands on a side");
  expect(misses({0, 0, 1}, {3, 0, 1}, {0, 3, 5}), "one that touches the tip");
  expect(misses({-9, -9, 0}, {9, -9, 0}, {0, 9, 0}), "one that holds a face");
  expect(!misses({-9, -9, 1e-300}, {9, -9, 1e-300}, {0, 9, 1e-300}), "one that is in by next to nothing");
  expect(!misses({0, 0, 0.1}, {0, 0.01, 0.1}, {0, 0, 0.11}), "one that is inside");
  expect(!misses({0, 0.1, -5}, {1e-9, 0.1, -5}, {0, 0.1, 5}), "a needle through it");
  expect(!misses({0, 0, 1}, {0, 0, 0}, {5, 0, 0.5}), "one that goes in at the tip");
  expect(misses({0, 0, 1 + 1e-15}, {5, 0, 1 + 1e-15}, {0, 5, 1 + 1e-15}), "one right above the tip");
}

// ---- answers ----

void add_box(Case& c, const std::string& name, const Vec3& low, const Vec3& high) {
  constexpr std::uint32_t kFaces[12][3] = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                                           {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  const auto first = static_cast<std::uint32_t>(c.scene.mesh.vertices.size());
  for (int i = 0; i < 8; ++i) {
    c.scene.mesh.vertices.emplace_back(i & 1 ? high.x() : low.x(), i & 2 ? high.y() : low.y(),
                                       i & 4 ? high.z() : low.z());
  }
  for (const auto& f : kFaces) {
    c.scene.mesh.triangles.push_back({first + f[0], first + f[1], first + f[2]});
    c.scene.object_of.push_back(static_cast<std::uint32_t>(c.scene.objects.size()));
  }
  c.scene.objects.push_back({name});
}

/// A square with a tower, a block and a pole in front of the middle of one side; an awning over part of the sky.
Case make_case(double scale, const Vec3& shift) {
  Case c;
  c.kind = "self-test";
  c.scale = scale;
  c.seed = 1;
  add_box(c, "tower", {2, -1, 0}, {3, 1, 5});
  add_box(c, "block", {-3, -2, 0}, {-2, 2, 1});
  add_box(c, "pole", {-0.01, 1.5, 0}, {0.01, 1.52, 4});
  add_box(c, "awning", {-1, -2, 2}, {1, -0.5, 2.2});
  for (Vec3& v : c.scene.mesh.vertices) v = scale * v + shift;
  vantage::Target target;
  for (const Vec3& p : {Vec3(-1, -1, 0), Vec3(1, -1, 0), Vec3(1.2, 0.7, 0), Vec3(0, 1, 0), Vec3(-1, 1, 0)})
    target.parts[0].push_back(scale * p + shift);
  c.parts = {target};
  c.range = 10 * scale;
  c.tolerance = 0.2 * scale;
  return c;
}

Case without(const Case& c, const std::string& name) {
  Case less = c;
  less.scene.mesh.triangles.clear();
  less.scene.object_of.clear();
  for (std::size_t i = 0; i < c.scene.mesh.triangles.size(); ++i) {
    if (display_name(c.scene.objects[c.scene.object_of[i]]) == name) continue;
    less.scene.mesh.triangles.push_back(c.scene.mesh.triangles[i]);
    less.scene.object_of.push_back(c.scene.object_of[i]);
  }
  return less;
}

Answer scaled(const Answer& answer, double factor) {
  Answer other = answer;
  const Vec3 centre = answer.volume.frame.origin;
  for (vantage::Volume* volume : {&other.volume, &other.parts[0]})
    for (Vec3& v : volume->mesh.vertices) v = centre + factor * (v - centre);
  return other;
}

/// Wrong answers to one case, each by its name, and what the judge must find.
class WrongAnswers {
 public:
  WrongAnswers(Case c, std::string name) : case_(std::move(c)), name_(std::move(name)), right_(ask_engine(case_)) {}

  void put() {
    expect(!right_.thrown, name_ + ": " + right_.message);
    if (right_.thrown) return;
    const Judgement judgement = judge(case_, right_);
    expect(!judgement.wrong(), name_ + ": objects to what is right: " + first_wrong(judgement));
    expect(judgement.status == "computed" && judgement.proved > 100 && judgement.unproved == 0, name_ + ": not proved");
    expect(judgement.lost < 1e-4, name_ + ": finds losses");
    put_volumes();
    put_sensors();
    put_meshes();
    put_refusals();
  }

 private:
  static std::string first_wrong(const Judgement& judgement) {
    for (const Finding& f : judgement.findings)
      if (is_wrong(f.which)) return std::string(attack::name_of(f.which)) + " " + f.detail;
    return "";
  }

  void must_find(FindingKind which, const std::string& what, const Answer& answer, const Case* other = nullptr) {
    JudgeOptions options;
    options.query = false;
    const Judgement judgement = judge(other ? *other : case_, answer, options);
    expect(judgement.find(which) != nullptr, name_ + ": lets pass: " + what);
    if (which == FindingKind::over_claim) expect(judgement.unproved > 0, name_ + ": proves: " + what);
  }

  void put_volumes() {
    for (const char* object : {"tower", "block", "pole", "awning"})
      must_find(FindingKind::over_claim, std::string("a volume without the ") + object,
                ask_engine(without(case_, object)));
    must_find(FindingKind::over_claim, "a volume larger by 1e-5", scaled(right_, 1 + 1e-5));
    must_find(FindingKind::out_of_range, "a volume larger by 1e-2", scaled(right_, 1.01));
    must_find(FindingKind::under_claim, "a volume smaller by 1e-3", scaled(right_, 1 - 1e-3));
    Case small_target = case_;
    small_target.parts[0].parts[0].erase(small_target.parts[0].parts[0].begin() + 2);
    must_find(FindingKind::over_claim, "a target that has lost a corner", ask_engine(small_target));
    Case limited = case_;
    const double height = case_.parts[0].parts[0][0].z();
    limited.navigation.altitude = {height + case_.scale, height + 3 * case_.scale};
    must_find(FindingKind::outside_limits, "a volume that was not cut", right_, &limited);
    Case two = case_;
    two.parts.push_back(two.parts[0]);
    for (Vec3& v : two.parts[1].parts[0]) v.x() += 0.5 * case_.scale;
    Answer one_part = right_;
    one_part.parts.push_back(right_.parts[0]);
    must_find(FindingKind::over_claim, "a volume of the first part alone", one_part, &two);
  }

  /// Volumes that were not cut to a limit of the sensor, and those that were.
  void put_sensors() {
    Case wanted = case_;
    const auto try_limit = [&](const char* limit, const vantage::Sensor& sensor) {
      wanted.sensor = sensor;
      must_find(FindingKind::outside_limits, std::string("a volume that is not cut to ") + limit, right_, &wanted);
      const Judgement judgement = judge(wanted, ask_engine(wanted));
      expect(judgement.status == "computed" && !judgement.wrong(), name_ + ": objects to " + limit);
    };
    try_limit("the least range", {.min_range_m = 0.3 * case_.range});
    try_limit("an incidence", {.incidence_deg = 50});
    try_limit("the sun", {.sun = vantage::SunLimit{Vec3(0.3, -0.5, -0.6), 15}});
    put_link();
  }

  void put_link() {
    Case wanted = case_;
    const Vec3 centre = right_.volume.frame.origin;
    wanted.parts[0] = vantage::Target::point(centre + 0.5 * case_.scale * Vec3::UnitZ());
    const Answer sight = ask_engine(wanted);
    constexpr double kLightGhzMetres = 0.299792458, kClear = 0.6;
    const double excess = 1e-3 * case_.range;
    wanted.sensor.link = vantage::RadioLink{kLightGhzMetres * kClear * kClear / (2 * excess), kClear};
    const Answer link = ask_engine(wanted);
    expect(!sight.thrown && !link.thrown, name_ + ": the link: " + sight.message + link.message);
    if (sight.thrown || link.thrown) return;
    expect(judge(wanted, sight).find(FindingKind::over_claim) != nullptr,
           name_ + ": lets pass: a link without its zone");
    const Judgement judgement = judge(wanted, link);
    expect(judgement.status == "computed" && !judgement.wrong(), name_ + ": objects to a link");
  }

  void put_meshes() {
    Answer answer = right_;
    answer.volume.mesh.triangles.pop_back();
    answer.volume.cause_of.pop_back();
    must_find(FindingKind::bad_mesh, "an open mesh", answer);
    answer = right_;
    std::swap(answer.volume.mesh.triangles[0][0], answer.volume.mesh.triangles[0][1]);
    must_find(FindingKind::bad_mesh, "a facet that is turned round", answer);
    answer = right_;
    answer.volume.mesh.triangles[0][0] = 1u << 30;
    must_find(FindingKind::bad_mesh, "an index out of range", answer);
    answer = right_;
    answer.volume.cause_of[0] = 99;
    must_find(FindingKind::bad_causes, "a cause out of range", answer);
    answer = right_;
    Mesh& mesh = answer.volume.mesh;  // a facet without area, and its edges cancelled
    const auto v = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.push_back(mesh.vertices[mesh.triangles[0][0]]);
    const std::uint32_t a = mesh.triangles[0][0], b = mesh.triangles[0][1];
    mesh.triangles.push_back({a, b, v});
    mesh.triangles.push_back({b, a, v});
    answer.volume.cause_of.resize(mesh.triangles.size(), 0);
    must_find(FindingKind::flat_facets, "facets without area", answer);
  }

  void put_refusals() {
    Answer answer;
    answer.thrown = true;
    answer.refusal = "pierced";
    must_find(FindingKind::false_refusal, "a refusal of what is clear", answer);
    answer.defect = true;
    must_find(FindingKind::defect, "an internal error", answer);
    answer = right_;
    answer.volume = answer.parts[0] = vantage::Volume();
    answer.volume.outcome = answer.parts[0].outcome = Outcome::out_of_range;
    answer.parts[0].frame = right_.parts[0].frame;
    must_find(FindingKind::bad_outcome, "no volume where there is one", answer);
  }

  Case case_;
  std::string name_;
  Answer right_;
};

}  // namespace

bool self_test() {
  test_signs();
  test_separation();
  for (const double scale : {1e-2, 1.0, 1e4})
    WrongAnswers(make_case(scale, Vec3::Zero()), "scale " + std::to_string(scale)).put();
  for (const double scale : {1e-1, 1e2})
    WrongAnswers(make_case(scale, Vec3(5e5, 5e6, 100)), "far, scale " + std::to_string(scale)).put();
  std::printf("self-test: %d failed\n", failures);
  return failures == 0;
}

}  // namespace attack
