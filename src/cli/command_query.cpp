#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <utility>

#include "cli/chosen_target.h"
#include "cli/command.h"
#include "cli/interrupt.h"
#include "cli/located_plan.h"
#include "cli/point_table.h"
#include "cli/progress_line.h"
#include "cli/row_reader.h"
#include "cli/standard_streams.h"
#include "common/atomic_file.h"
#include "common/input.h"
#include "common/output.h"
#include "vantage/earth.h"
#include "vantage/error.h"
#include "vantage/flight.h"
#include "vantage/fraction.h"
#include "vantage/mission.h"
#include "vantage/query.h"

namespace vantage::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* kQueryExamples =
    "POINTS\n"
    "  A row each; commas, semicolons, tabs or blanks separate the columns. A header may name them: x, y, z in metres\n"
    "  of the scene frame, z up; or lon, lat in degrees (WGS 84) and z, for a scene that says where on the earth it\n"
    "  lies. Without a header the first three columns are taken. z is the scene's: measured from the flat ground of a\n"
    "  map, or from the zero of its terrain. A column amsl instead of z is metres above mean sea level, a column agl\n"
    "  metres above the ground under the point. Titles are those that check reads, and may have units, amsl_ft or\n"
    "  \"Altitude (m)\"; for those that do not say what they are measured from, as alt, --heights does.\n"
    "\n"
    "ANSWERS\n"
    "  The table of the points, all of its columns in their order, and after them\n"
    "  inside,margin_m,blocked_by,out_of_range,behind_target,outside_of: margin_m is the signed distance to the\n"
    "  volume's boundary along the line to the target's centre, positive inside. Navigation limits bound it too, the\n"
    "  target itself does not; -inf where no point of that line is in the volume. Several names in a field are joined\n"
    "  with ';', and a ';' or '\\' within a name has a '\\' before it. A field of names that begins with = + - @ or '\n"
    "  has a ' before it, so that no spreadsheet takes it for a formula. With --json: an array of objects, one a line; "
    "-inf is null, and columns that are not coordinates are\n"
    "  text.\n"
    "\n"
    "FRACTION\n"
    "  --fraction adds a last column, fraction: which part of the target the point sees, 0 to 1, by line of sight\n"
    "  alone. It is exact, not sampled, and 1 only where nothing hides any of the target. Measured by the area of the\n"
    "  target; by its solid_angle from the point; or by the pixels of its image, in a camera that looks along the "
    "axis\n"
    "  of the narrowest cone about the target. --seen also writes the seen parts, as GeoJSON polygons with holes, one\n"
    "  feature a point: in longitude and latitude where the scene says where on the earth it lies, else in x and y of\n"
    "  the scene frame.\n"
    "\n"
    "EXAMPLES\n"
    "  vantage query mission.yaml points.csv\n"
    "  vantage query mission.yaml points.csv -o answers.csv\n"
    "  echo 10 20 35 | vantage query mission.yaml -\n"
    "  vantage query mission.yaml track.csv --lonlat --z 60 --json | jq '.[] | select(.inside)'\n"
    "  vantage query mission.yaml photos.csv --heights sea\n"
    "  vantage query mission.yaml points.csv --fraction solid_angle -o answers.csv --seen seen.geojson\n";

struct QueryArguments {
  CommonOptions common;
  std::string mission_file, points_file, output_file, target;
  std::string fraction, seen_file;  // empty: not asked for
  std::string z, heights;           // as typed
  bool lonlat = false, json = false;

  bool is_to_stdout() const { return output_file.empty() || is_standard_stream(output_file); }
};

/// The points' file, or standard input.
class Source {
 public:
  explicit Source(const std::string& file) {
    if (is_standard_stream(file)) return;
    check_readable(file, "the points file", "");
    descriptor_ = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
    if (descriptor_ >= 0) return;
    throw Error(ErrorCode::file_unreadable, std::string("the points file cannot be read: ") + std::strerror(errno),
                file, "check its permissions");
  }
  ~Source() {
    if (descriptor_ != STDIN_FILENO) ::close(descriptor_);
  }
  Source(const Source&) = delete;
  Source& operator=(const Source&) = delete;

  int descriptor() const { return descriptor_; }

 private:
  int descriptor_ = STDIN_FILENO;
};

/// Where answers go, as they come: standard output, or a file that is put in place when all are there.
class Sink {
 public:
  Sink(const std::string& file, bool is_stdout) {
    if (!is_stdout) file_ = std::make_unique<AtomicFile>(file);
  }
  void write(const std::string& text) {
    if (file_) {
      file_->write(text);
    } else {
      print(text);
    }
  }
  /// The file, to be put in place; null for standard output.
  std::unique_ptr<AtomicFile> release() { return std::move(file_); }

 private:
  std::unique_ptr<AtomicFile> file_;
};

TableOptions table_options(const QueryArguments& options, bool has_targets) {
  TableOptions result;
  result.lonlat = options.lonlat;
  result.json = options.json;
  result.fraction = !options.fraction.empty();
  result.target = has_targets;
  result.heights = datum_of(options.heights);
  if (options.z.empty()) return result;
  result.z = length_option("--z", options.z);
  return result;
}

void tell_of_columns(const PointTable& table) {
  if (table.is_ambiguous()) note("the points have x, y and lon, lat: x and y are used; --lonlat uses the others");
  const std::string used = table.height_name().empty() ? "--z" : table.height_name();
  for (const std::string& name : table.unused_heights()) {
    note(std::string("the points have ").append(used).append(" and ").append(name).append(": ").append(used) +
         " is used");
  }
  if (table.replaced().empty()) return;
  std::string names;
  for (const std::string& name : table.replaced()) names += (names.empty() ? "" : ", ") + name;
  note("columns of the points that the answers replace: " + names);
}

void tell_of_heights(const Scene& scene) {
  const std::string level = scene.georeference ? scene.georeference->vertical : "";
  note("z of the points is metres above " + (level.empty() ? "the zero of the scene's file" : level));
}

/// The height of what the points' heights are measured from, above the zero of the scene's heights.
double zero_of(const Mission& mission, const PointTable& table, const std::string& points) {
  const std::optional<Georeference>& place = mission.scene().georeference;
  const std::string level = place ? place->vertical : "";
  const HeightDatum height = table.height();
  if (height == HeightDatum::sea_level) {
    if (const auto sea_level = sea_level_m(mission)) return *sea_level;
  }
  if (height == HeightDatum::home && mission.home) {
    return place && !is_map(*place) ? height_m(*place, *mission.home) : mission.home->z();
  }
  constexpr const char* kEllipsoid = "ellipsoidal height";  // Georeference::vertical
  if (height == HeightDatum::ellipsoid && level == kEllipsoid) return 0;
  throw Error(
      ErrorCode::heights_differ,
      table.height_name() + " of the points is above " +
          (height == HeightDatum::sea_level ? "mean sea level" : name_of(height)) +
          (height == HeightDatum::home ? ", and the mission's tour has no home"
                                       : ", and z of the scene above " + (level.empty() ? "an unknown level" : level)),
      points,
      height == HeightDatum::sea_level
          ? "say with 'scene.sea_level' which z of the scene the mean sea level has, or give z or agl"
          : "give z, amsl or agl");
}

/// Throws Error(input) where the heights of the points cannot be those of the scene.
PointFrame frame_of(const Mission& mission, const PointTable& table, const std::string& points) {
  const Scene& scene = mission.scene();
  PointFrame frame{scene.georeference, bounding_box(scene.mesh)};
  const HeightDatum height = table.height();
  if (height != HeightDatum::scene_z && height != HeightDatum::ground) {
    frame.zero_m = zero_of(mission, table, points);
  }
  if (height == HeightDatum::ground) {
    try {
      frame.ground.emplace(ground_of(mission));
    } catch (const Error& error) {
      if (error.code() != ErrorCode::ground_missing) throw;
      throw Error(
          ErrorCode::ground_missing,
          table.height_name() + " of the points is above the ground, and the scene does not say what of it is ground",
          points, "give z or amsl, or a scene with ground: a map, or what 'vantage scene' made of one");
    }
  }
  return frame;
}

/// Rows of one portion, with their coordinates.
struct Portion {
  std::vector<Row> rows;
  std::vector<Vec3> coordinates;
};

/// All that is wrong with a row is found before any of the portion is answered.
Portion parsed(PointTable& table, std::span<const Row> rows) {
  Portion portion;
  portion.rows.assign(rows.begin(), rows.end());
  for (const Row& row : rows) portion.coordinates.push_back(table.coordinates(row));
  return portion;
}

/// Answers portions of points, and writes what was asked for.
class Answers {
 public:
  /// One query for each of `targets`, the names that rows are told apart by where there are several.
  Answers(const QueryArguments& options, PointFrame frame, PointTable& table, std::vector<std::string> targets,
          std::vector<ViewsQuery> queries)
      : frame_(std::move(frame)),
        table_(table),
        targets_(std::move(targets)),
        queries_(std::move(queries)),
        rows_(options.output_file, options.is_to_stdout()) {
    fraction_.measure = fraction_measure(options.fraction).value_or(FractionMeasure::area);
    fraction_.with_polygons = !options.seen_file.empty();
    if (!fraction_.with_polygons) return;
    seen_ = std::make_unique<Sink>(options.seen_file, is_standard_stream(options.seen_file));
    features_.emplace(frame_.place, fraction_.measure);
  }

  void begin() {
    text_ = table_.beginning();
    if (seen_) seen_->write(features_->beginning());
  }

  void add(const Portion& portion) {
    std::vector<Vec3> points;
    for (std::size_t i = 0; i < portion.rows.size(); ++i) {
      points.push_back(table_.scene_point(portion.coordinates[i], frame_, portion.rows[i]));
    }
    std::vector<std::vector<PointAnswer>> answers;
    std::vector<std::vector<PointFraction>> fractions;
    for (ViewsQuery& query : queries_) {
      answers.push_back(query.answer(points));
      if (table_.has_fraction()) fractions.push_back(fractions_of(*query.single(), points));
    }
    std::string features;
    for (std::size_t i = 0; i < points.size(); ++i) {
      for (std::size_t target = 0; target < queries_.size(); ++target) {
        const std::optional<double> fraction =
            fractions.empty() ? std::nullopt : std::optional(fractions[target][i].fraction);
        table_.append(text_, portion.rows[i], portion.coordinates[i], answers[target][i], fraction, targets_[target]);
        if (seen_) features += features_->feature(fractions[target][i], table_.id(portion.rows[i]));
      }
    }
    rows_.write(text_);
    text_.clear();
    if (seen_) seen_->write(features);
  }

  void end() {
    rows_.write(text_ + table_.end());  // with the beginning where there were no points
    if (seen_) seen_->write(features_->end());
    std::vector<std::unique_ptr<AtomicFile>> files;
    for (Sink* sink : {&rows_, seen_.get()}) {
      if (std::unique_ptr<AtomicFile> file = sink ? sink->release() : nullptr) files.push_back(std::move(file));
    }
    commit_all(files);
  }

 private:
  /// A few at a time: where many gaps are looked through, each takes milliseconds.
  std::vector<PointFraction> fractions_of(PointQuery& query, std::span<const Vec3> points) {
    constexpr std::size_t kAtOnce = 256;
    std::vector<PointFraction> result;
    while (result.size() < points.size()) {
      stop_if_interrupted();
      const std::size_t count = std::min(kAtOnce, points.size() - result.size());
      for (PointFraction& one : query.fractions(points.subspan(result.size(), count), fraction_)) {
        result.push_back(std::move(one));
      }
    }
    return result;
  }

  PointFrame frame_;
  PointTable& table_;
  std::vector<std::string> targets_;
  std::vector<ViewsQuery> queries_;
  FractionOptions fraction_;
  Sink rows_;
  std::unique_ptr<Sink> seen_;
  std::optional<SeenGeoJson> features_;
  std::string text_;
};

/// Each volume of the mission, or that of --target, prepared in one scene.
std::vector<ViewsQuery> queries_of(const Mission& mission, const PreparedScene& scene) {
  std::vector<ViewsQuery> queries;
  for (std::size_t i = 0; i < volume_count(mission); ++i) {
    const Mission one = one_volume(mission, i);
    queries.emplace_back(prepare_views(one, scene), one.navigation);
  }
  return queries;
}

void check_seen(const QueryArguments& options) {
  if (options.seen_file.empty()) return;
  constexpr const char* kWhere = "command line, --seen";
  if (options.fraction.empty()) {
    throw Error(ErrorCode::missing_key, "--seen does not say by what the seen part is measured", kWhere,
                "add --fraction area, solid_angle or pixels");
  }
  if (is_standard_stream(options.seen_file)) {
    if (!options.is_to_stdout()) return;
    throw Error(ErrorCode::output_named_twice, "the answers and --seen both want standard output", kWhere,
                "write one of them to a file");
  }
  check_can_write(options.seen_file);
  if (!is_standard_stream(options.points_file)) check_not_an_input(options.seen_file, {options.points_file});
  if (!options.is_to_stdout() && fs::weakly_canonical(options.seen_file) == fs::weakly_canonical(options.output_file)) {
    throw Error(ErrorCode::output_named_twice, "an output is named twice", options.seen_file, "give each a name");
  }
}

[[noreturn]] void fail_seen_point() {
  throw Error(ErrorCode::not_applicable, "a single point has no part that could be drawn", "command line, --seen",
              "leave it out, or give the target an area");
}

/// What can be said of the mission before its scene is read.
void check_mission(const QueryArguments& options, const MissionFile& file) {
  if (!options.is_to_stdout()) check_not_an_input(options.output_file, input_files(file));
  if (options.seen_file.empty()) return;
  if (!is_standard_stream(options.seen_file)) check_not_an_input(options.seen_file, input_files(file));
  if (!file.lists_targets() && file.targets.front().target.is_point()) fail_seen_point();
}

/// A part of one target is seen, not of several of which one is enough.
void check_fraction(const QueryArguments& options, const Mission& mission) {
  if (options.fraction.empty()) return;
  for (std::size_t i = 0; i < volume_count(mission); ++i) {
    const Mission one = one_volume(mission, i);
    if (!options.seen_file.empty() && one.target.is_point()) fail_seen_point();
    if (one.views.empty()) continue;
    throw Error(ErrorCode::not_applicable, "--fraction is of one target, and the mission combines several",
                "command line, --fraction", "leave it out, or write 'combine: each' for targets with one side");
  }
}

void check_streams(const QueryArguments& options) {
  const bool is_from_stdin = is_standard_stream(options.points_file);
  if (is_from_stdin && is_standard_stream(options.mission_file)) {
    throw Error(ErrorCode::stdin_not_possible, "the mission and the points cannot both come from standard input",
                "command line, MISSION and POINTS", "write one of them to a file");
  }
  if (options.is_to_stdout()) return;
  check_can_write(options.output_file);
  if (!is_from_stdin) check_not_an_input(options.output_file, {options.points_file});
}

int run_query(const QueryArguments& options) {
  check_streams(options);
  check_seen(options);
  const MissionFile file = read_mission_argument(options.mission_file);
  const TableOptions columns = table_options(options, file.combine == Combine::each && options.target.empty());
  check_mission(options, file);
  const bool is_from_stdin = is_standard_stream(options.points_file);
  const bool is_quiet = options.common.quiet;
  if (file.method == Method::spheres && !is_quiet) {
    note("the mission's method is spheres; queries are always answered exactly, for the whole target");
  }
  if (is_from_stdin && !is_quiet && ::isatty(STDIN_FILENO) == 1) {
    note("reading points from the keyboard; end with Ctrl-D");
  }
  const Source source(options.points_file);
  ProgressLine progress(options.common);
  RowReader reader(source.descriptor(), is_from_stdin ? "standard input" : options.points_file, stop_if_interrupted);

  // The first rows before the scene: a mistake in them is told at once.
  const std::vector<Row>& first = reader.next();
  const Row no_row;
  PointTable table(reader, first.empty() ? no_row : first.front(), columns);
  Portion portion = parsed(table, std::span(first).subspan(table.has_header() ? 1 : 0));
  if (portion.rows.empty()) portion = parsed(table, reader.next());  // the header came alone
  if (!is_quiet) tell_of_columns(table);

  Mission mission = resolve_mission(file, progress.callback());
  if (!options.target.empty()) mission = of_target(mission, options.target);
  check_fraction(options, mission);
  const Scene& scene = mission.scene();
  for (const Warning& warning : mission_warnings(mission)) {
    const bool is_missing =
        warning.code == WarningCode::scene_incomplete || warning.code == WarningCode::zones_left_out;
    if (is_missing && !is_quiet) note(warning.text);
  }
  if (table.is_lonlat() && table.height() == HeightDatum::scene_z && !is_quiet) tell_of_heights(scene);
  if (!options.seen_file.empty() && !scene.georeference && !is_quiet) {
    note("the seen parts are in x, y, z of the scene frame: the scene does not say where on the earth it lies");
  }
  PointFrame frame = frame_of(mission, table, is_from_stdin ? "standard input" : options.points_file);
  Answers answers(options, std::move(frame), table, target_names(mission),
                  queries_of(mission, PreparedScene(scene, progress.callback())));
  answers.begin();
  while (!portion.rows.empty()) {
    answers.add(portion);
    stop_if_interrupted();
    portion = parsed(table, reader.next());
  }
  answers.end();
  if (table.swapped() > 0 && !is_quiet) {
    note("outside of the scene, and inside with longitude and latitude the other way round: " +
         std::to_string(table.swapped()) + " of the points; are the columns in the right order?");
  }
  return kSuccess;
}

}  // namespace

void add_query(CLI::App& app, Command& chosen) {
  CLI::App* command =
      app.add_subcommand("query", "Test for each point whether the whole target is visible from it, and if not, why");
  auto options = std::make_shared<QueryArguments>();
  command->add_option("mission", options->mission_file, "The mission; - for standard input")
      ->required()
      ->option_text("MISSION");
  command->add_option("points", options->points_file, "File of points; - for standard input")
      ->required()
      ->option_text("POINTS");
  command
      ->add_option("-o,--output", options->output_file,
                   "Write the answers to a file; -, the default, is standard output")
      ->option_text("FILE");
  command->add_flag("--lonlat", options->lonlat, "The points are longitude and latitude in degrees, WGS 84");
  CLI::Option* const z =
      command->add_option("--z", options->z, "One height for all points; the table then needs no column z")
          ->option_text("METRES");
  add_heights_option(*command, options->heights, "the points do")->excludes(z);
  command->add_option("--target", options->target, kTargetHelp)->option_text("NAME");
  command->add_flag("--json", options->json, "Write a JSON array of objects, one per line");
  command
      ->add_option("--fraction", options->fraction,
                   "Add which part of the target each point sees, measured by area, solid angle or pixels")
      ->option_text("MEASURE")
      ->check(CLI::IsMember({"area", "solid_angle", "pixels"}));
  command
      ->add_option("--seen", options->seen_file,
                   "Write the seen parts of the target to a GeoJSON file; - is standard output")
      ->option_text("FILE");
  finish<QueryArguments>(*command, options, kQueryExamples, chosen, run_query);
}

}  // namespace vantage::cli
