#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include "flights.h"
#include "isolated.h"
#include "tours.h"
#include "vantage/error.h"

namespace attack {
namespace {

FlightJudgement judge_number(std::uint64_t seed, std::size_t index) {
  try {
    return judge_flight(draw_flight(seed, index), ask_check_flight);
  } catch (const vantage::Error& error) {
    FlightJudgement refused;
    refused.words.push_back(std::string("flight, refused: ") + name_of(error.code()));
    if (error.kind() != vantage::ErrorKind::input) refused.add_wrong(std::string("error: ") + error.what());
    return refused;
  }
}

std::string on_one_line(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

FlightJudgement judge_tour_number(std::uint64_t seed, std::size_t index) {
  FlightJudgement result;
  try {
    const DrawnTour drawn = draw_tour(seed, index);
    const AnsweredTour answer = ask_tour(drawn);
    judge_tour(drawn, answer, result);
    judge_bound(drawn, answer, result);
    result.words.emplace_back("tour");
    const std::string kind = drawn.mission ? "tour of a mission" : "tour of regions";
    result.words.push_back(
        kind + (name_of(drawn.settings.vehicle.kind) == std::string("fixed_wing") ? ", fixed wing" : ", multirotor"));
    result.words.emplace_back(answer.tour.is_complete() ? "tour of all targets" : "tour that leaves targets out");
    result.count("targets in view", static_cast<double>(answer.tour.tour.visits.size()));
    result.count("metres", answer.tour.tour.length_m);
  } catch (const vantage::Error& error) {
    result.words.push_back(std::string("tour, refused: ") + name_of(error.code()));
    if (error.kind() != vantage::ErrorKind::input) result.add_wrong(std::string("error: ") + error.what());
  }
  return result;
}

std::string to_text(const FlightJudgement& judgement) {
  std::ostringstream text;
  for (const std::string& word : judgement.words) text << "+" << on_one_line(word) << "\n";
  for (const std::string& wrong : judgement.wrong) text << "-" << on_one_line(wrong) << "\n";
  for (const auto& [what, count] : judgement.counts) text << "#" << count << " " << what << "\n";
  return text.str();
}

/// What is drawn, judged, and written where it is wrong.
struct AttackKind {
  std::string name;  ///< "flight"
  FlightJudgement (*judge)(std::uint64_t seed, std::size_t index);
  void (*write)(std::uint64_t seed, std::size_t index, const std::string& wrong, const std::string& folder);
};

void write_wrong_flight(std::uint64_t seed, std::size_t index, const std::string& wrong, const std::string& folder) {
  const DrawnFlight small = minimise_flight(draw_flight(seed, index), wrong, ask_check_flight);
  write_flight(small, wrong, folder);
  std::printf("      %zu points, %zu triangles: %s\n", small.flight.points.size(),
              small.mission.scene().mesh.triangles.size(), folder.c_str());
}

void write_wrong_tour(std::uint64_t seed, std::size_t index, const std::string& wrong, const std::string& folder) {
  const DrawnTour drawn = draw_tour(seed, index);
  std::filesystem::create_directories(folder);
  write_scene(drawn.scene, std::filesystem::path(folder) / "scene.obj");
  std::ofstream(std::filesystem::path(folder) / "README.txt") << wrong << "\n" << drawn.kind << "\n";
  std::printf("      %s\n", folder.c_str());
}

class FlightAttack {
 public:
  FlightAttack(const FlightRun& run, AttackKind kind) : run_(run), kind_(std::move(kind)) {}

  bool run() {
    const char* name = kind_.name.c_str();
    std::printf("seed %llu, %ss %zu to %zu; one of them: vantage_attack --%ss 1 --seed %llu --only NUMBER\n",
                static_cast<unsigned long long>(run_.seed), name, run_.first, run_.first + run_.count - 1, name,
                static_cast<unsigned long long>(run_.seed));
    Processes(run_.jobs, run_.seconds)
        .run_each(
            run_.first, run_.count, [this](std::size_t index) { return to_text(kind_.judge(run_.seed, index)); },
            [this](std::size_t index, const Exit& exit) { note(index, exit); });
    for (const auto& [word, count] : words_) std::printf("%12zu  %s\n", count, word.c_str());
    for (const auto& [what, count] : counts_) std::printf("%12.0f  %s\n", count, what.c_str());
    std::printf("%zu drawn: %zu wrong\n", run_.count, wrong_);
    const bool are_enough = run_.count < 100 || 10 * words_[kind_.name] >= 5 * run_.count;
    if (!are_enough) std::printf("WRONG too few are judged: the others are refused\n");
    return wrong_ == 0 && are_enough;
  }

 private:
  void note(std::size_t index, const Exit& exit) {
    std::vector<std::string> wrong;
    if (exit.crashed) wrong.push_back("crash: " + exit.how);
    if (exit.hung) wrong.push_back("hang: " + exit.how);
    std::istringstream lines(exit.crashed || exit.hung ? "" : exit.text);
    for (std::string line; std::getline(lines, line);) {
      if (line.starts_with("+")) ++words_[line.substr(1)];
      if (line.starts_with("-")) wrong.push_back(line.substr(1));
      if (!line.starts_with("#")) continue;
      const std::size_t blank = line.find(' ');
      counts_[line.substr(blank + 1)] += std::stod(line.substr(1, blank));
    }
    wrong_ += !wrong.empty();
    for (const std::string& text : wrong) {
      std::printf("WRONG %s %zu: %s\n", kind_.name.c_str(), index, text.c_str());
      write(index, text);
    }
    std::fflush(stdout);
  }

  void write(std::size_t index, const std::string& wrong) {
    if (run_.out.empty()) return;
    const std::string kind = wrong.substr(0, wrong.find(':'));
    if (written_[kind]++ >= run_.written) return;
    std::string name = kind;
    std::replace(name.begin(), name.end(), ' ', '-');
    const std::string folder = run_.out + "/" + name + "-" + std::to_string(run_.seed) + "-" + std::to_string(index);
    kind_.write(run_.seed, index, wrong, folder);
  }

  FlightRun run_;
  AttackKind kind_;
  std::map<std::string, std::size_t> words_;
  std::map<std::string, double> counts_;
  std::map<std::string, int> written_;
  std::size_t wrong_ = 0;
};

}  // namespace

bool run_drawn_flights(const FlightRun& run) {
  return FlightAttack(run, {"flight", judge_number, write_wrong_flight}).run();
}

bool run_drawn_tours(const FlightRun& run) {
  return FlightAttack(run, {"tour", judge_tour_number, write_wrong_tour}).run();
}

}  // namespace attack
