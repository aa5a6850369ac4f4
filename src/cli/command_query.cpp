#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <iostream>
#include <iterator>
#include <memory>

#include "cli/command.h"
#include "cli/output_check.h"
#include "cli/point_list.h"
#include "cli/progress_line.h"
#include "mission/input_file.h"
#include "mission/run_mission.h"
#include "solid/atomic_file.h"
#include "vantage/error.h"
#include "vantage/query.h"

namespace vantage::cli {
namespace {

constexpr const char* kExamples =
    "POINTS\n"
    "  One in a row, in metres, z up; separated by commas, semicolons or blanks. A header may name the columns x, y, "
    "z;\n"
    "  without one the first three are taken.\n"
    "\n"
    "ANSWERS\n"
    "  x,y,z,inside,margin_m,blocked_by,out_of_range,behind_target,outside_of: margin_m is the signed distance to the\n"
    "  volume's boundary along the line to the target's centre, positive inside. Navigation limits bound it too, the\n"
    "  target itself does not; -inf where no point of that line is in the volume. Several names in one field are "
    "joined\n"
    "  with ';'.\n"
    "\n"
    "EXAMPLES\n"
    "  vantage query mission.yaml points.csv\n"
    "  vantage query mission.yaml points.csv -o answers.csv\n"
    "  echo 10 20 35 | vantage query mission.yaml -\n";

struct Options {
  CommonOptions common;
  std::string mission_file, points_file, output_file;
};

std::string read_all(const std::string& file) {
  if (file == "-") {
    std::string text{std::istreambuf_iterator<char>(std::cin), std::istreambuf_iterator<char>()};
    if (std::cin.bad()) throw Error(ErrorKind::input, "the points cannot be read", "standard input", "send them again");
    return text;
  }
  mission_io::check_readable(file, "the points file", "");
  std::ifstream stream(file, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  if (stream.bad()) {
    throw Error(ErrorKind::input, std::string("the points file cannot be read: ") + std::strerror(errno), file,
                "check the disk that it lies on");
  }
  return text;
}

/// The whole target is seen where all its parts are.
void narrow(std::vector<PointAnswer>& answers, const std::vector<PointAnswer>& of_part) {
  for (std::size_t i = 0; i < answers.size(); ++i) {
    PointAnswer& answer = answers[i];
    const PointAnswer& other = of_part[i];
    answer.inside = answer.inside && other.inside;
    answer.margin_m = std::min(answer.margin_m, other.margin_m);
    std::vector<std::string> blockers;
    std::set_union(answer.blocked_by.begin(), answer.blocked_by.end(), other.blocked_by.begin(), other.blocked_by.end(),
                   std::back_inserter(blockers));
    answer.blocked_by = std::move(blockers);
    answer.out_of_range = answer.out_of_range || other.out_of_range;
    answer.behind_target = answer.behind_target || other.behind_target;
  }
}

int run(const Options& options) {
  const bool is_from_stdin = options.points_file == "-";
  if (!options.output_file.empty()) {
    check_can_write(options.output_file);
    if (!is_from_stdin) check_not_an_input(options.output_file, {options.points_file});
  }
  Mission mission = read_mission(options.mission_file);
  if (!options.output_file.empty()) check_not_an_input(options.output_file, input_files(mission));
  if (mission.method == Method::spheres && !options.common.quiet) {
    note("the mission's method is spheres; queries are always answered exactly, for the whole target");
  }
  if (is_from_stdin && !options.common.quiet && ::isatty(STDIN_FILENO) == 1) {
    note("reading points from the keyboard; end with Ctrl-D");
  }
  const std::vector<Vec3> points =
      parse_points(read_all(options.points_file), is_from_stdin ? "standard input" : options.points_file);

  ProgressLine progress(options.common);
  const PreparedScene scene(read_mission_scene(mission, progress.callback()).scene, progress.callback());
  std::vector<PointAnswer> answers = mission_io::with_place(mission.target_place, [&] {
    return query_points(scene, mission.target, mission.sensor, mission.navigation, points);
  });
  for (const Target& part : mission.other_parts) {
    narrow(answers, mission_io::with_place(mission.target_place, [&] {
             return query_points(scene, part, mission.sensor, mission.navigation, points);
           }));
  }
  const std::string text = answers_text(points, answers);
  stop_if_interrupted();
  if (options.output_file.empty()) {
    print(text);
  } else {
    solid::write_whole_file(options.output_file, text);
  }
  return kSuccess;
}

}  // namespace

void add_query(CLI::App& app, Command& chosen) {
  CLI::App* command = app.add_subcommand("query", "Say of each point whether it sees the whole target, and why not");
  auto options = std::make_shared<Options>();
  command->add_option("mission", options->mission_file, "The mission")->required()->option_text("MISSION");
  command->add_option("points", options->points_file, "File of points; - for standard input")
      ->required()
      ->option_text("POINTS");
  command->add_option("-o,--output", options->output_file, "Write the answers to a file, not to standard output")
      ->option_text("FILE");
  finish<Options>(*command, options, kExamples, chosen, run);
}

}  // namespace vantage::cli
