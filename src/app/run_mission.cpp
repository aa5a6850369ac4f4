#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <string_view>
#include <utility>

#include "app/combine_targets.h"
#include "app/ground_target.h"
#include "app/join_volumes.h"
#include "app/kept_volumes.h"
#include "app/pierced_advice.h"
#include "app/providers/spheres.h"
#include "app/scene_warnings.h"
#include "common/input.h"
#include "core/parallel.h"
#include "core/places.h"
#include "core/stopwatch.h"
#include "vantage/error.h"
#include "vantage/mission.h"
#include "vantage/navigation.h"
#include "vantage/sensor.h"
#include "vantage/volume.h"

namespace vantage {
namespace {

using PreparedViews = std::vector<std::vector<PreparedTarget>>;

/// Of several parts and targets: what was done for all of them, on the one device that they have.
void add_report(const SpheresReport& part, std::optional<SpheresReport>& all) {
  if (!all) {
    all = part;
    return;
  }
  all->spheres += part.spheres;
  all->pairs += part.pairs;
  all->splits += part.splits;
  all->unresolved_pairs += part.unresolved_pairs;
  all->render_seconds += part.render_seconds;
  all->boolean_seconds += part.boolean_seconds;
}

/// What is wrong with one target: others of the same mission may be right.
struct TargetError : Error {
  explicit TargetError(const Error& error) : Error(error) {}
};

/// One of several targets is named where an error does not do so itself: it may be a part of an entry, which has no
/// line of its own.
Error naming(const Error& error, const Mission& mission, const Target& target) {
  const auto says_name = [&](const std::string& text) { return text.find(target.name) != std::string::npos; };
  const bool is_alone = mission.as_written.targets.size() < 2 || target.name.empty();
  if (is_alone || says_name(error.problem()) || says_name(error.where())) return error;
  std::string where = error.where();
  if (!where.empty()) where += ", ";
  where += "target ";
  return error.with_where(where + in_quotes(target.name));
}

/// Calls `action` and returns what it returns. An Error(input) from it is one of this target.
template <typename Action>
auto about_target(const Mission& mission, const Target& target, const Action& action) {
  try {
    return internal::core::with_place(mission.as_written.places.target, action);
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::input) throw;
    throw TargetError(naming(error, mission, target));
  }
}

/// What the method of spheres cannot do.
void check_method(const Mission& mission) {
  if (mission.as_written.method != Method::spheres) return;
  if (mission.sensor.link) {
    throw Error(ErrorCode::not_applicable, "the method of spheres knows no zones of radio links",
                mission.as_written.places.sensor, "use 'method: exact', or leave out sensor.link");
  }
  if (mission.sensor.visible) {
    throw Error(ErrorCode::not_applicable, "the method of spheres cannot tell how much of a target is seen",
                mission.as_written.places.sensor, "use 'method: exact', or leave 'visible' out");
  }
}

/// What would be wrong for every target.
void check_what_all_share(const Mission& mission) {
  internal::core::with_place(mission.as_written.places.sensor, [&] {
    check_sensor(mission.sensor);
    return 0;
  });
  check_method(mission);
  internal::core::with_place(mission.as_written.file.string(), [&] {
    check_navigation(mission.navigation);
    return 0;
  });
}

/// Whether each target is several faces that must all be seen from one position. With other targets beside them these
/// may be what cannot be seen.
bool are_faces_together(const Mission& mission) {
  const auto faces = std::count_if(mission.notes.begin(), mission.notes.end(),
                                   [](const Warning& note) { return note.code == WarningCode::faces_together; });
  return static_cast<std::size_t>(faces) == mission.as_written.targets.size();
}

Volume compute(const Mission& mission, const PreparedTarget& target, const RunOptions& run, Result& result,
               const Progress& progress) {
  if (mission.as_written.method == Method::exact) {
    ExactOptions options = mission.as_written.exact;
    options.threads = 0;  // those of the arena that the mission runs in
    return internal::app::kept_or_computed(run.kept, target, options.tolerance_m,
                                           [&] { return compute_view(target, options, progress); });
  }
  check_method(mission);
  SpheresOptions options = mission.as_written.spheres;
  options.threads = 0;
  const auto georeferenced = [&](const SphereStage& stage) {
    SphereStage copy = stage;
    copy.georeference = mission.scene().georeference;
    run.stages(copy);
  };
  const StageSink sink = run.stages ? StageSink(georeferenced) : StageSink();
  const auto& provider = internal::app::spheres_provider("missions with method: spheres", "method");
  std::vector<Volume> volumes;
  for (std::size_t i = 0; i < target.part_count(); ++i) {
    SpheresReport report;
    volumes.push_back(provider.compute_visibility_spheres(target.part(i), options, &report, sink, progress));
    add_report(report, result.spheres);
  }
  return internal::app::joined(std::move(volumes), progress, mission.as_written.exact.work_limit);
}

/// The volume of one target, within all limits.
Volume limited(const Mission& mission, const PreparedTarget& target, const RunOptions& options, Result& result,
               Seconds& seconds, internal::core::Stopwatch& stopwatch, const Progress& progress) {
  Volume volume;
  try {
    volume = compute(mission, target, options, result, progress);
  } catch (const Error& error) {
    // The target itself is checked by now. The exact method may still find it too large for the tolerance; the method
    // of spheres refuses only its options and devices, which the mission names elsewhere.
    if (mission.as_written.method == Method::spheres) throw;
    about_target(mission, target.target(), [&]() -> int { throw error; });
  }
  seconds.engine += stopwatch.lap();
  const bool is_limited = !mission.navigation.empty() || target.sensor().limits_view();
  if (volume.outcome == Outcome::computed && is_limited) {
    try {
      volume = cut_to_limits(volume, target, mission.navigation, progress, mission.as_written.exact.work_limit);
    } catch (const Error& error) {
      const auto throw_it = [&]() -> int { throw error; };
      // How much work the limits are depends on the volume that they cut: another target may need less.
      if (error.code() == ErrorCode::work_too_large) about_target(mission, target.target(), throw_it);
      internal::core::with_place(mission.as_written.file.string(), throw_it);
    }
    seconds.navigation += stopwatch.lap();
  }
  return volume;
}

/// What each list of targets leaves, and then what all have in common.
Volume of_views(const Mission& mission, const PreparedViews& views, const RunOptions& options, Result& result,
                Seconds& seconds, internal::core::Stopwatch& stopwatch, const Progress& progress) {
  std::vector<Volume> all;
  for (const std::vector<PreparedTarget>& view : views) {
    std::vector<Volume> any;
    for (const PreparedTarget& target : view) {
      any.push_back(limited(mission, target, options, result, seconds, stopwatch, progress));
    }
    all.push_back(internal::app::united(std::move(any), progress, mission.as_written.exact.work_limit));
  }
  Volume volume = internal::app::joined(std::move(all), progress, mission.as_written.exact.work_limit);
  if (volume.outcome == Outcome::no_common_view && are_faces_together(mission)) {
    volume.hint =
        "choose faces that one position sees: 'facing: north', 'nearest: [x, y, z]'; or write 'combine: each' for a "
        "volume of each face, 'combine: any' for what sees one of them";
  }
  seconds.engine += stopwatch.lap();
  return volume;
}

/// `prepare_seconds`: that preparing the scene took; `stopwatch`: its last lap ended with that.
Result run(const Mission& mission, const PreparedViews& views, double prepare_seconds,
           internal::core::Stopwatch& stopwatch, const RunOptions& options, const Progress& progress) {
  Result result;
  Seconds seconds;
  seconds.read = mission.read_seconds;
  seconds.prepare = prepare_seconds;
  result.scene = views.front().front().scene().statistics();
  result.volume = of_views(mission, views, options, result, seconds, stopwatch, progress);
  seconds.total = seconds.read + seconds.prepare + seconds.engine + seconds.navigation;
  result.volume.seconds = seconds;
  result.volume.attribution = attribution_of(mission.scene());
  result.volume.georeference = mission.scene().georeference;
  if (auto& place = result.volume.georeference) place->attribution = result.volume.attribution;
  if (result.volume.provenance) {
    const std::string& known = options.scene_hash;
    result.volume.provenance->scene_hash = known.empty() ? scene_hash(mission.scene()) : known;
    result.volume.provenance->mission_hash = mission_hash(mission);
  }
  std::vector<Warning> warnings = mission_warnings(mission, &result.volume);
  result.volume.notes.insert(result.volume.notes.end(), warnings.begin(), warnings.end());
  return result;
}

PreparedTarget prepare(const Mission& mission, const Target& target, const PreparedScene& scene) {
  const GroundTarget* const ground = internal::app::only_ground_target(mission.as_written);
  return about_target(mission, target, [&] {
    internal::app::refuse_in_stand_ins(*mission.loaded, target);
    try {
      return PreparedTarget(scene, target, mission.sensor);
    } catch (const Error& error) {
      if (error.code() != ErrorCode::target_pierced) throw;
      throw internal::app::explained(error, *mission.loaded, ground ? ground->osm : "");
    }
  });
}

PreparedScene prepared_scene(const Mission& mission, const RunOptions& options, const Progress& progress) {
  return options.prepared ? *options.prepared : PreparedScene(mission.scene(), progress);
}

void check_one_volume(const Mission& mission) {
  if (volume_count(mission) == 1) return;
  throw Error(ErrorCode::not_applicable, "the mission asks for a volume for each of its targets",
              mission.as_written.places.target, "write 'combine: all' or 'combine: any' for one volume");
}

/// A callback for work that goes on at several places at once: what is done of all of it, one call at a time.
class SharedProgress {
 public:
  SharedProgress(const Progress& callback, std::size_t count) : callback_(callback), count_(count) {}

  Progress callback() {
    if (!callback_) return {};
    return [this](std::string_view, double) { return tell(); };
  }
  void finish_one() {
    ++done_;
    if (callback_ && !tell()) throw Error(ErrorCode::cancelled, "cancelled", "", "");
  }

 private:
  bool tell() {
    const std::lock_guard lock(mutex_);
    is_wanted_ = is_wanted_ && callback_("targets", static_cast<double>(done_) / static_cast<double>(count_));
    return is_wanted_;
  }

  const Progress& callback_;
  std::size_t count_;
  std::atomic<std::size_t> done_ = 0;
  bool is_wanted_ = true;
  std::mutex mutex_;
};

}  // namespace

const char* name_of(Method method) { return method == Method::spheres ? "spheres" : "exact"; }

namespace {

void check_one_target(const Mission& mission) {
  if (mission.views.empty()) return;
  throw Error(ErrorCode::not_applicable, "the mission has several targets, and one alone is not what it asks for",
              mission.as_written.file.string(), "use prepare_views, and run_mission without a prepared target");
}

enum class OnError { stop, go_on };

/// A result for each volume. `OnError::go_on`: or what is wrong with its target.
std::vector<Attempt> run_each(const Mission& mission, const RunOptions& options, OnError on_error,
                              const Progress& progress) {
  const std::size_t count = volume_count(mission);
  std::vector<Attempt> attempts(count);
  check_what_all_share(mission);
  internal::parallel::with_threads(options.threads, [&] {
    internal::core::Stopwatch stopwatch;
    const PreparedScene scene = prepared_scene(mission, options, progress);
    RunOptions for_each;
    for_each.kept = options.kept;
    for_each.scene_hash = options.scene_hash.empty() ? scene_hash(mission.scene()) : options.scene_hash;
    const double prepare_seconds = stopwatch.lap();
    std::vector<PreparedViews> prepared(count);
    const internal::core::ProgressReporter asking(progress);
    asking.begin("targets");
    for (std::size_t i = 0; i < count; ++i) {
      asking.tick();
      try {
        prepared[i] = prepare_views(one_volume(mission, i), scene);
      } catch (const TargetError& error) {
        if (on_error == OnError::stop) throw;
        attempts[i].error = error;
      }
    }
    internal::app::begin_run(options.kept);
    SharedProgress shared(progress, count);
    // An exception that leaves a parallel loop also ends the loops inside the others, which would go on with half of
    // their results: it is thrown when all are done. After the first one no more are begun.
    std::vector<std::exception_ptr> thrown(count);
    std::atomic<bool> has_failed = false;
    const auto run_one = [&](std::size_t i) {
      internal::core::Stopwatch own;
      attempts[i].result = run(one_volume(mission, i), prepared[i], 0, own, for_each, shared.callback());
    };
    internal::parallel::for_ranges(count, 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end && !has_failed; ++i) {
        try {
          try {
            if (!attempts[i].error) run_one(i);
          } catch (const TargetError& error) {
            if (on_error == OnError::stop) throw;
            attempts[i].error = error;
          }
          shared.finish_one();
        } catch (...) {
          thrown[i] = std::current_exception();
          has_failed = true;
        }
      }
    });
    for (const std::exception_ptr& one : thrown) {
      if (one) std::rethrow_exception(one);
    }
    for (Attempt& attempt : attempts) {
      if (!attempt.result) continue;
      attempt.result->volume.seconds.prepare = prepare_seconds;
      attempt.result->volume.seconds.total += prepare_seconds;
      break;
    }
  });
  return attempts;
}

}  // namespace

PreparedTarget prepare_target(const Mission& mission, const PreparedScene& scene) {
  check_one_target(mission);
  return prepare(mission, mission.target, scene);
}

std::vector<std::vector<PreparedTarget>> prepare_views(const Mission& mission, const PreparedScene& scene) {
  PreparedViews views;
  for (const std::vector<Target>& list : internal::app::views_of(mission)) {
    views.emplace_back();
    for (const Target& target : list) views.back().push_back(prepare(mission, target, scene));
  }
  return views;
}

Result run_mission(const Mission& mission, const RunOptions& options, const Progress& progress) {
  check_one_volume(mission);
  Result result;
  internal::parallel::with_threads(options.threads, [&] {
    internal::core::Stopwatch stopwatch;
    const PreparedScene scene = prepared_scene(mission, options, progress);
    const double prepare_seconds = stopwatch.lap();
    const PreparedViews views = prepare_views(mission, scene);
    internal::app::begin_run(options.kept);
    result = run(mission, views, prepare_seconds, stopwatch, options, progress);
  });
  return result;
}

Result run_mission(const Mission& mission, const PreparedTarget& target, const RunOptions& options,
                   const Progress& progress) {
  check_one_target(mission);
  internal::app::begin_run(options.kept);
  Result result;
  internal::parallel::with_threads(options.threads, [&] {
    internal::core::Stopwatch stopwatch;
    result = run(mission, {{target}}, 0, stopwatch, options, progress);
  });
  return result;
}

std::vector<Result> run_missions(const Mission& mission, const RunOptions& options, const Progress& progress) {
  if (volume_count(mission) == 1) return {run_mission(mission, options, progress)};
  std::vector<Result> results;
  for (Attempt& attempt : run_each(mission, options, OnError::stop, progress)) {
    results.push_back(std::move(*attempt.result));
  }
  return results;
}

std::vector<Attempt> try_missions(const Mission& mission, const RunOptions& options, const Progress& progress) {
  return run_each(mission, options, OnError::go_on, progress);
}

}  // namespace vantage
