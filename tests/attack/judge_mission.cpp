#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <sstream>

#include "closed_mesh.h"
#include "isolated.h"
#include "limit_attack.h"
#include "missions.h"
#include "random.h"
#include "vantage/error.h"
#include "vantage/mission.h"
#include "vantage/prove.h"
#include "vantage/query.h"
#include "vantage/result.h"
#include "vantage/volume.h"

namespace attack {
namespace {

using vantage::Mission;
using vantage::PointAnswer;
using vantage::Vec3;
using vantage::Volume;

std::string text_of(const Vec3& p) {
  char text[100];
  std::snprintf(text, sizeof text, "(%.17g, %.17g, %.17g)", p.x(), p.y(), p.z());
  return text;
}

/// To compare them: a reader may number vertices anew.
std::vector<Vec3> in_order(std::vector<Vec3> points) {
  std::sort(points.begin(), points.end(), [](const Vec3& a, const Vec3& b) {
    return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
  });
  return points;
}

/// What PointQuery says of all targets of a mission together.
class Answers {
 public:
  Answers(const Mission& mission, const vantage::PreparedScene& scene) {
    for (const auto& view : prepare_views(mission, scene)) {
      queries_.emplace_back();
      for (const vantage::PreparedTarget& target : view) queries_.back().emplace_back(target, mission.navigation);
    }
  }

  std::vector<PointAnswer> of(const std::vector<Vec3>& points) {
    std::vector<std::vector<PointAnswer>> all(points.size());
    for (std::vector<vantage::PointQuery>& view : queries_) {
      std::vector<std::vector<PointAnswer>> any(points.size());
      for (vantage::PointQuery& query : view) {
        const std::vector<PointAnswer> answers = query.answer(points);
        for (std::size_t i = 0; i < points.size(); ++i) any[i].push_back(answers[i]);
      }
      for (std::size_t i = 0; i < points.size(); ++i) all[i].push_back(any_of(any[i]));
    }
    std::vector<PointAnswer> result;
    for (const std::vector<PointAnswer>& answers : all) result.push_back(all_of(answers));
    return result;
  }

 private:
  std::vector<std::vector<vantage::PointQuery>> queries_;
};

std::vector<Vec3> centres_of(const Mission& mission) {
  std::vector<Vec3> centres;
  const auto add = [&](const vantage::Target& target) {
    for (std::size_t part = 0; part < target.parts.size(); ++part) {
      centres.push_back(make_target_frame(target, part).origin);
    }
  };
  if (mission.views.empty()) add(mission.target);
  for (const auto& view : mission.views) {
    for (const vantage::Target& target : view) add(target);
  }
  return centres;
}

std::string reasons(const PointAnswer& answer) {
  std::string text;
  for (const std::string& name : answer.blocked_by) text += " hidden by " + name;
  for (const std::string& name : answer.outside_of) text += " outside of " + name;
  if (answer.out_of_range) text += " out of range";
  if (answer.behind_target) text += " behind";
  return text;
}

class VolumeJudge {
 public:
  VolumeJudge(const Mission& mission, const Volume& volume, const vantage::PreparedScene& scene, Random& random)
      : mission_(mission), random_(random), answers_(mission, scene), centres_(centres_of(mission)) {
    const vantage::Box box = bounding_box(volume.mesh);
    origin_ = ((box.min + box.max) / 2).array().round();  // so that subtracting it rounds nothing
    diagonal_ = (box.max - box.min).norm();
    largest_ = std::max(box.min.cwiseAbs().maxCoeff(), box.max.cwiseAbs().maxCoeff());
    local_ = volume.mesh;
    for (Vec3& v : local_.vertices) v -= origin_;
    tolerance_ = volume.tolerance_m;
  }

  std::vector<std::string> run() {
    const vantage::MeshMeasures measures = measure(local_);
    if (!measures.closed || !measures.oriented) return {"the mesh is not closed"};
    if (!(measures.volume_m3 > 0)) return {"the mesh encloses nothing"};
    const MeshFaults found = faults(local_);
    if (found.flat_facets > 0) wrong_.push_back(std::to_string(found.flat_facets) + " flat facets");
    const ClosedMesh mesh(local_);
    judge_claims(mesh);
    if (has_exact_limits()) judge_losses(mesh);
    return wrong_;
  }

  /// The prover looks at every facet; what it says is wrong has a witness. Of missions that it knows.
  std::vector<std::string> prove(const Volume& volume) const {
    try {
      check_provable(mission_);
    } catch (const vantage::Error&) {
      return {};
    }
    std::vector<std::string> wrong;
    for (const vantage::ClaimProof& claim : prove_volume(mission_, volume.mesh, {.lift_m = volume.lift_m}).claims) {
      if (claim.verdict == vantage::ProofVerdict::wrong) wrong.push_back("proof: " + claim.name + " " + claim.text);
    }
    return wrong;
  }

 private:
  /// Less deep than this nothing is guaranteed.
  double depth(const Vec3& local) const {
    double farthest = 0;
    for (const Vec3& centre : centres_) farthest = std::max(farthest, (local + origin_ - centre).norm());
    return 1e-6 * farthest + 1e-8 * diagonal_ + 32 * std::numeric_limits<double>::epsilon() * largest_;
  }

  Vec3 on_facet() {
    const auto t = static_cast<std::size_t>(random_.next() % local_.triangles.size());
    const auto& [a, b, c] = local_.triangles[t];
    double u = random_.uniform(0, 1), v = random_.uniform(0, 1);
    if (u + v > 1) {
      u = 1 - u;
      v = 1 - v;
    }
    const auto& p = local_.vertices;
    const Vec3 at = p[a] + u * (p[b] - p[a]) + v * (p[c] - p[a]);
    const Vec3 normal = (p[b] - p[a]).cross(p[c] - p[a]);
    return normal.norm() > 0 ? Vec3(at - 2 * depth(at) * normal.normalized()) : at;
  }

  void judge_claims(const ClosedMesh& mesh) {
    constexpr int kPoints = 60;
    std::vector<Vec3> points;
    for (int i = 0; i < kPoints; ++i) {
      Vec3 p = on_facet();
      if (i % 3 == 0) p += random_.uniform(0, 1) * (on_facet() - p);
      if (mesh.locate(p) == Place::inside && mesh.distance(p) > depth(p)) points.push_back(p + origin_);
    }
    const std::vector<PointAnswer> answers = answers_.of(points);
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (answers[i].inside) continue;
      wrong_.push_back("over-claim at " + text_of(points[i]) + ", " +
                       std::to_string(mesh.distance(points[i] - origin_)) + " m inside:" + reasons(answers[i]));
      return;
    }
  }

  /// Limits whose surfaces are flat, and so cut where they are.
  bool has_exact_limits() const {
    const vantage::Sensor& sensor = mission_.sensor;
    bool are_flat = !sensor.link && !sensor.visible;
    const auto look = [&](auto limit, const auto& /*value*/) { are_flat = are_flat && facts_of<limit>().is_flat; };
    each_limit(mission_.navigation, look);
    each_limit(sensor, look);
    return are_flat;
  }

  void judge_losses(const ClosedMesh& mesh) {
    constexpr int kPoints = 40;
    const double range = range_limit_m(mission_.sensor), room = 2 * tolerance_ + 1e-3 * range;
    std::vector<Vec3> points;
    for (int i = 0; i < kPoints; ++i) {
      const Vec3& centre = centres_[static_cast<std::size_t>(random_.next() % centres_.size())];
      const Vec3 at = centre + range * random_.uniform(0, 1) * random_.direction();
      points.push_back(at);
      for (int axis = 0; axis < 3; ++axis) {
        for (const double side : {-room, room}) points.push_back(at + side * Vec3::Unit(axis));
      }
    }
    const std::vector<PointAnswer> answers = answers_.of(points);
    constexpr std::size_t kEach = 7;
    for (std::size_t i = 0; i < points.size(); i += kEach) {
      const auto first = answers.begin() + static_cast<std::ptrdiff_t>(i);
      const bool is_inside = std::all_of(first, first + kEach, [](const PointAnswer& answer) { return answer.inside; });
      const Vec3 local = points[i] - origin_;
      if (!is_inside || mesh.locate(local) != Place::outside || mesh.distance(local) < room / 2) continue;
      wrong_.push_back("under-claim at " + text_of(points[i]) + ", " + std::to_string(mesh.distance(local)) +
                       " m outside");
      return;
    }
  }

  const Mission& mission_;
  Random& random_;
  Answers answers_;
  std::vector<Vec3> centres_;
  Vec3 origin_ = Vec3::Zero();
  double diagonal_ = 0, largest_ = 0, tolerance_ = 0;
  vantage::Mesh local_;
  std::vector<std::string> wrong_;
};

/// Words of the mission's text that are counted.
std::vector<std::string> words_of(const std::string& text) {
  std::vector<std::string> counted = {"combine: all", "combine: any", "combine: each", "sides: both", "targets:",
                                      "point:",       "outline:",     "parts:",        "part: roof",  "part: facade",
                                      "vertices:",    "link:",        "visible:"};
  every_limit([&](auto limit) {
    for (const std::string& word : facts_of<limit>().words) counted.push_back(word);
  });
  std::vector<std::string> words;
  for (const std::string& word : counted) {
    if (text.find(word) != std::string::npos) words.push_back(word);
  }
  return words;
}

}  // namespace

MissionJudgement judge_drawn_mission(const DrawnMission& drawn) {
  MissionJudgement judgement;
  judgement.words = words_of(drawn.text);
  if (!drawn.meshes.empty()) judgement.words.emplace_back("meshes");
  Random random(drawn.seed);
  try {
    auto loaded = std::make_shared<vantage::LoadedScene>();
    loaded->scene = drawn.scene;
    Mission mission = resolve_mission(vantage::read_mission_text(drawn.text, "drawn.yaml", {}), loaded);
    mission.navigation.meshes = drawn.meshes;
    const vantage::PreparedScene scene(mission.scene());
    const std::vector<vantage::Result> results = run_missions(mission, {.threads = 1, .prepared = scene});
    for (std::size_t i = 0; i < results.size(); ++i) {
      const Volume& volume = results[i].volume;
      judgement.words.emplace_back(name_of(volume.outcome));
      if (volume.outcome != vantage::Outcome::computed) continue;
      const Mission one = one_volume(mission, i);
      VolumeJudge judge(one, volume, scene, random);
      for (std::string& wrong : judge.run()) judgement.wrong.push_back(wrong);
      for (std::string& wrong : judge.prove(volume)) judgement.wrong.push_back(wrong);
    }
  } catch (const vantage::Error& error) {
    judgement.words.push_back(std::string("refused: ") + name_of(error.code()));
    if (error.kind() != vantage::ErrorKind::input) {
      judgement.wrong.push_back(std::string(name_of(error.code())) + ": " + error.what());
    }
  } catch (const std::exception& error) {
    judgement.wrong.push_back(error.what());
  }
  return judgement;
}

bool MissionCounts::are_enough_computed() const {
  constexpr double kLeast = 0.4;
  constexpr std::size_t kFew = 20;  // of so few any number may be refused by chance
  return all < kFew || static_cast<double>(computed) >= kLeast * static_cast<double>(all);
}

bool run_drawn_missions(const MissionRun& run) {
  std::printf("seed %llu, missions %zu to %zu; one of them: vantage_attack --missions 1 --seed %llu --only NUMBER\n",
              static_cast<unsigned long long>(run.seed), run.first, run.first + run.count - 1,
              static_cast<unsigned long long>(run.seed));
  std::map<std::string, std::size_t> counts;
  MissionCounts total;
  const auto note = [&](std::size_t index, const std::vector<std::string>& faults) {
    if (faults.empty()) return;
    ++total.wrong;
    for (const std::string& fault : faults) {
      std::string line = fault;
      std::replace(line.begin(), line.end(), '\n', ' ');
      std::printf("WRONG mission %zu: %s\n", index, line.c_str());
    }
    if (!run.out.empty()) {
      const std::string folder = run.out + "/mission-" + std::to_string(run.seed) + "-" + std::to_string(index);
      write_drawn_mission(draw_mission(run.seed, index), folder);
      std::printf("      %s\n", folder.c_str());
    }
    std::fflush(stdout);
  };
  const auto work = [&run](std::size_t index) {
    const MissionJudgement judgement = judge_drawn_mission(draw_mission(run.seed, index));
    std::string text;
    for (const std::string& word : judgement.words) text += "+" + word + "\n";
    for (std::string fault : judgement.wrong) {
      std::replace(fault.begin(), fault.end(), '\n', ' ');
      text += "-" + fault + "\n";
    }
    return text;
  };
  Processes(run.jobs, run.seconds).run_each(run.first, run.count, work, [&](std::size_t index, const Exit& exit) {
    ++total.all;
    if (exit.crashed || exit.hung) {
      ++counts[exit.hung ? "hung" : "crashed"];
      note(index, {(exit.hung ? "took too long: " : "crashed: ") + exit.how});
      return;
    }
    std::istringstream lines(exit.text);
    std::vector<std::string> faults;
    bool is_computed = false, is_refused = false;
    for (std::string line; std::getline(lines, line);) {
      if (line.starts_with("+")) ++counts[line.substr(1)];
      if (line.starts_with("-")) faults.push_back(line.substr(1));
      is_computed = is_computed || line == std::string("+") + name_of(vantage::Outcome::computed);
      is_refused = is_refused || line.starts_with("+refused: ");
    }
    ++(is_refused ? total.refused : is_computed ? total.computed : total.empty);
    note(index, faults);
  });
  for (const auto& [word, count] : counts) std::printf("%8zu  %s\n", count, word.c_str());
  std::printf("%zu missions: %zu computed, %zu without a volume, %zu refused; %zu wrong\n", total.all, total.computed,
              total.empty, total.refused, total.wrong);
  if (!total.are_enough_computed()) std::printf("WRONG too few missions were computed\n");
  return total.wrong == 0 && total.are_enough_computed();
}

bool mission_self_test() {
  int failures = 0;
  const auto expect = [&](bool holds, const std::string& what) {
    if (holds) return;
    ++failures;
    std::printf("self-test: %s\n", what.c_str());
  };
  const MissionCounts half{.all = 100, .computed = 50, .refused = 50}, few{.all = 100, .computed = 30, .refused = 70};
  expect(half.are_enough_computed() && !few.are_enough_computed(), "the least number of computed missions");
  const auto folder = std::filesystem::temp_directory_path() /
                      ("vantage-attack-" + std::to_string(static_cast<unsigned long>(::getpid())));
  int resolved = 0, with_mesh = 0, with_ground = 0;
  for (std::size_t index = 0; index < 60; ++index) {
    const DrawnMission drawn = draw_mission(1, index);
    auto loaded = std::make_shared<vantage::LoadedScene>();
    loaded->scene = drawn.scene;
    std::optional<Mission> drawn_mission;
    try {
      drawn_mission = resolve_mission(vantage::read_mission_text(drawn.text, "drawn.yaml", {}), loaded);
    } catch (const vantage::Error&) {
      continue;  // many are refused
    }
    const Mission& mission = *drawn_mission;
    try {
      write_drawn_mission(drawn, folder.string());
      const Mission again = resolve_mission(vantage::read_mission(folder / "mission.yaml"));
      const std::string name = "mission " + std::to_string(index) + " reads back with ";
      const vantage::Scene &a = mission.scene(), &b = again.scene();
      expect(a.mesh.vertices == b.mesh.vertices && a.mesh.triangles == b.mesh.triangles, name + "another scene");
      for (std::size_t t = 0; t < std::min(a.object_of.size(), b.object_of.size()); ++t) {
        const vantage::SceneObject &of_a = a.objects[a.object_of[t]], &of_b = b.objects[b.object_of[t]];
        expect(of_a.name == of_b.name && of_a.kind == of_b.kind, name + "other objects");
      }
      const std::vector<vantage::KeepInMesh>& meshes = again.navigation.meshes;
      expect(meshes.size() == drawn.meshes.size(), name + "other meshes");
      for (std::size_t i = 0; i < std::min(meshes.size(), drawn.meshes.size()); ++i) {
        expect(in_order(meshes[i].mesh.vertices) == in_order(drawn.meshes[i].mesh.vertices),
               name + "another mesh to stay in");
      }
      ++resolved;
      with_mesh += !meshes.empty();
      with_ground += a.objects[0].kind == vantage::ObjectKind::ground;
    } catch (const vantage::Error& error) {
      expect(false, "mission " + std::to_string(index) + " cannot be read back: " + error.what());
    }
  }
  std::filesystem::remove_all(folder);
  expect(resolved > 20 && with_mesh > 0 && with_ground > 0, "too few missions are read back");
  std::printf("self-test of missions: %d failed\n", failures);
  return failures == 0;
}

}  // namespace attack
