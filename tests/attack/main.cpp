// Attacks the exact engine with scenes that are degenerate on purpose: docs/verification.md.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "draw.h"
#include "findings_text.h"
#include "flights.h"
#include "isolated.h"
#include "mesh_attack.h"
#include "mesh_self_test.h"
#include "minimise.h"
#include "missions.h"
#include "self_test.h"
#include "summary.h"
#include "tours.h"
#include "vantage/city.h"

namespace attack {
namespace {

struct Options {
  std::uint64_t seed = 1;
  std::size_t scenes = 2000, first = 0;
  int jobs = 2, minimised = 3;
  unsigned seconds = 60;
  std::filesystem::path out, mission;
  std::size_t meshes = 0;
  bool self_test = false, told = false, only = false, missions = false, flights = false, tours = false;
};

constexpr const char* kUsage =
    R"(usage: vantage_attack [options]
  --scenes N     how many scenes to draw (2000)
  --meshes N     draw so many meshes instead, and judge what the proof says of them
  --missions N   draw N missions instead, of every kind of target, side, combination and limit
  --flights N    draw N flights instead, and judge what check_flight says of them
  --tours N      draw N tours instead, and judge whether they are what was asked for
  --first I      the number of the first scene, mesh, mission, flight or tour (0)
  --seed S       of all draws (1)
  --only I       that scene, mesh, mission, flight or tour alone, and all that is found in it
  --mission FILE a mission of a mesh scene instead of draws
  --out DIR      write what fails there, made small: scene.obj, mission.yaml
  --minimised N  how many of each class are made small and written (3)
  --told         also print and write what is told but not failed
  --jobs N       processes at once (2)
  --seconds N    processor time of one scene; more is a failure (60)
  --self-test    check that the judge objects to what is wrong
exit code: 0 nothing is wrong, 1 something is, 2 the options are
)";

/// Exits with 2 for what it does not know.
Options parse(int count, char** words) {
  Options options;
  const auto fail = [] {
    std::fputs(kUsage, stderr);
    std::exit(2);
  };
  for (int i = 1; i < count; ++i) {
    const std::string word = words[i];
    const auto value = [&]() -> const char* {
      if (i + 1 >= count) fail();
      return words[++i];
    };
    const auto number = [&] {
      char* end = nullptr;
      const char* text = value();
      const unsigned long long n = std::strtoull(text, &end, 10);
      if (*text < '0' || *text > '9' || *end != 0) fail();
      return n;
    };
    if (word == "--scenes") {
      options.scenes = number();
    } else if (word == "--meshes") {
      options.meshes = number();
    } else if (word == "--missions") {
      options.missions = true;
      options.scenes = number();
    } else if (word == "--flights") {
      options.flights = true;
      options.scenes = number();
    } else if (word == "--tours") {
      options.tours = true;
      options.scenes = number();
    } else if (word == "--first") {
      options.first = number();
    } else if (word == "--seed") {
      options.seed = number();
    } else if (word == "--only") {
      options.first = number();
      options.only = options.told = true;
    } else if (word == "--mission") {
      options.mission = value();
    } else if (word == "--out") {
      options.out = value();
    } else if (word == "--minimised") {
      options.minimised = static_cast<int>(number());
    } else if (word == "--told") {
      options.told = true;
    } else if (word == "--jobs") {
      options.jobs = std::max(1, static_cast<int>(number()));
    } else if (word == "--seconds") {
      options.seconds = static_cast<unsigned>(number());
    } else if (word == "--self-test") {
      options.self_test = true;
    } else {
      fail();
    }
  }
  if (options.only) options.scenes = 1;
  return options;
}

JudgeOptions judge_options(std::size_t index) {
  JudgeOptions options;
  options.reversed = index % 7 == 3;
  return options;
}

void print(const Finding& f, std::size_t index, const Case& c) {
  std::printf("%s %s: scene %zu, scale %g (%s): share %.3g at (%.17g, %.17g, %.17g) %s\n",
              is_wrong(f.which) ? "WRONG" : "told", name_of(f.which), index, c.scale, c.kind.c_str(), f.share,
              f.place.x(), f.place.y(), f.place.z(), f.detail.c_str());
}

class Attack {
 public:
  explicit Attack(const Options& options) : options_(options) {}

  int run() {
    std::printf("seed %llu, scenes %zu to %zu; one of them: vantage_attack --seed %llu --only NUMBER\n",
                static_cast<unsigned long long>(options_.seed), options_.first, options_.first + options_.scenes - 1,
                static_cast<unsigned long long>(options_.seed));
    const auto work = [this](std::size_t index) {
      const Case c = draw_case(options_.seed, index);
      return to_text(judge(c, ask_engine(c), judge_options(index)));
    };
    Processes(options_.jobs, options_.seconds)
        .run_each(options_.first, options_.scenes, work,
                  [this](std::size_t index, const Exit& exit) { note(index, exit); });
    std::fputs(summary_.text().c_str(), stdout);
    return summary_.wrong() > 0 ? 1 : 0;
  }

 private:
  void note(std::size_t index, const Exit& exit) {
    const Case c = draw_case(options_.seed, index);
    Judgement judgement;
    if (exit.crashed || exit.hung) {
      judgement.add({exit.hung ? FindingKind::hang : FindingKind::crash, 0, Vec3::Zero(), exit.how});
    } else {
      judgement = from_text(exit.text);
    }
    summary_.add(c, judgement);
    for (const Finding& f : judgement.findings) {
      if (!is_wrong(f.which) && !options_.told) continue;
      print(f, index, c);
      if (!options_.out.empty() && written_[f.which]++ < options_.minimised) write(index, c, f);
    }
    std::fflush(stdout);
  }

  void write(std::size_t index, const Case& c, const Finding& f) {
    const bool slow = f.which == FindingKind::hang;
    const Case small =
        minimise(c, f, judge_options(index), slow ? options_.seconds / 4 : options_.seconds, slow ? 25 : 300);
    std::string folder = name_of(f.which);
    std::replace(folder.begin(), folder.end(), ' ', '-');
    const std::filesystem::path place =
        options_.out / (folder + "-" + std::to_string(options_.seed) + "-" + std::to_string(index));
    write_case(small, place);
    std::ofstream note(place / "README.txt");
    note << name_of(f.which) << ", share " << f.share << ", at " << f.place.transpose() << ", " << f.detail << "\n"
         << "drawn as scene " << index << " of seed " << options_.seed << " at scale " << c.scale << ": " << c.kind
         << "\nvantage_attack --mission " << (place / "mission.yaml").string() << "\n";
    std::printf("      %zu triangles, %zu corners: %s\n", small.scene.mesh.triangles.size(),
                small.parts[0].parts[0].size(), place.c_str());
  }

  Options options_;
  Summary summary_;
  std::map<FindingKind, int> written_;
};

int judge_mission(const Options& options) {
  const Case c = read_case(options.mission);
  const Judgement judgement = judge_isolated(c, judge_options(3), options.seconds);
  std::printf(
      "%s: %zu viewpoints inside, %zu facets, %zu proved, %zu of a smaller target, %zu not; lift %g m; lost %.4f %%\n",
      judgement.status.c_str(), judgement.viewpoints, judgement.facets, judgement.proved, judgement.proved_smaller,
      judgement.unproved, judgement.lift, 100 * judgement.lost);
  for (const Finding& f : judgement.findings) print(f, 0, c);
  return judgement.wrong() ? 1 : 0;
}

}  // namespace
}  // namespace attack

int main(int count, char** words) {
  vantage::enable_maps();
  const attack::Options options = attack::parse(count, words);
  if (options.self_test) {
    const bool are_right[] = {attack::self_test(), attack::mesh_self_test(), attack::mission_self_test(),
                              attack::flight_self_test(), attack::tour_self_test()};
    return std::all_of(std::begin(are_right), std::end(are_right), [](bool is) { return is; }) ? 0 : 1;
  }
  if (options.missions) {
    return attack::run_drawn_missions({.seed = options.seed,
                                       .first = options.first,
                                       .count = options.scenes,
                                       .jobs = options.jobs,
                                       .seconds = options.seconds,
                                       .out = options.out.string()})
               ? 0
               : 1;
  }
  if (options.flights || options.tours) {
    return (options.tours ? attack::run_drawn_tours : attack::run_drawn_flights)({.seed = options.seed,
                                                                                  .first = options.first,
                                                                                  .count = options.scenes,
                                                                                  .jobs = options.jobs,
                                                                                  .seconds = options.seconds,
                                                                                  .out = options.out.string(),
                                                                                  .written = options.minimised})
               ? 0
               : 1;
  }
  if (!options.mission.empty()) return attack::judge_mission(options);
  if (options.meshes > 0) {
    return attack::attack_with_meshes({.seed = options.seed,
                                       .first = options.first,
                                       .count = options.only ? 1 : options.meshes,
                                       .jobs = options.jobs,
                                       .seconds = options.seconds,
                                       .out = options.out,
                                       .written = options.minimised,
                                       .told = options.told});
  }
  return attack::Attack(options).run();
}
