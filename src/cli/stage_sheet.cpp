#include "cli/stage_sheet.h"

#include "cli/picture_options.h"
#include "cli/text_table.h"
#include "vantage/result.h"
#include "vantage/volume.h"

namespace vantage::cli {
namespace {

constexpr std::size_t kMostSteps = 12;  // of each kind: more is told, not drawn
constexpr int kColumns = 4;

/// Draws panels of one frame.
class SheetMaker {
 public:
  SheetMaker(const Mission& mission, const PictureView& view, std::array<int, 2> size, const Progress& progress)
      : mission_(mission), scene_(mission.scene()), view_(view), size_(size), progress_(progress) {}

  void make(const std::vector<StageFile>& stages) {
    load(stages);
    panel("scene and target", nullptr, view_, false);
    for (const char* kind : {"sphere", "pair"}) steps(stages, kind);
    result();
  }

  std::vector<PicturePanel> panels;
  std::string note;  ///< what is left out

 private:
  void load(const std::vector<StageFile>& stages) {
    for (const StageFile& stage : stages) {
      if (stage.mesh.empty()) continue;
      if (stage.kind == "result") result_ = read_volume(stage.mesh, scene_, progress_).volume;
      if (stage.kind == "sphere" && frame_.empty()) {
        frame_ = read_volume(stage.mesh, scene_, progress_).volume.mesh.vertices;
      }
    }
    frame_.insert(frame_.end(), result_.mesh.vertices.begin(), result_.mesh.vertices.end());
    for (const std::vector<Vec3>& part : mission_.target.parts) {
      frame_.insert(frame_.end(), part.begin(), part.end());
    }
  }

  void panel(const std::string& caption, const Volume* volume, const PictureView& view, bool with_limits) {
    PictureRequest request;
    request.target = &mission_.target;
    request.volume = volume;
    request.view = view;
    request.width = size_[0];
    request.height = size_[1];
    request.annotate = false;
    request.frame = frame_;
    if (with_limits) request.navigation = limits_to_draw();
    panels.push_back({render_picture(scene_, request, progress_), caption});
  }

  /// An altitude band is drawn as the box that it cuts out of the result's surroundings.
  Navigation limits_to_draw() const {
    Navigation limits = mission_.navigation;
    if (!limits.keep_in.empty() || !limits.altitude) return limits;
    Box box;
    for (const Vec3& point : frame_) box.extend(point);
    box.min.z() = limits.altitude->min_m;
    box.max.z() = limits.altitude->max_m;
    limits.keep_in.push_back(box);
    return limits;
  }

  void steps(const std::vector<StageFile>& stages, const std::string& kind) {
    std::size_t drawn = 0, left = 0;
    for (const StageFile& stage : stages) {
      if (stage.kind != kind || stage.mesh.empty()) continue;
      if (drawn == kMostSteps) {
        ++left;
        continue;
      }
      const Volume volume = read_volume(stage.mesh, scene_, progress_).volume;
      panel(stage.name + ", Euler number " + std::to_string(stage.euler), &volume, view_, false);
      ++drawn;
    }
    if (left > 0) note += " \u00b7 " + std::to_string(left) + " more " + kind + "s are not shown";
  }

  void result() {
    if (result_.mesh.empty()) return;
    PictureView top;
    top.kind = PictureView::Kind::top;
    panel("result from the top", &result_, top, false);
    panel("result", &result_, view_, false);
    if (mission_.navigation.empty()) return;
    panel("where the vehicle may fly", nullptr, view_, true);
    const Volume whole = result_.causes.empty() ? volume_of_mesh(result_.mesh, "scene") : result_;
    const Volume cut = cut_to_navigation(whole, mission_.navigation, progress_);
    panel(cut.mesh.empty() ? "navigable result: empty" : "navigable result", &cut, view_, true);
  }

  const Mission& mission_;
  const Scene& scene_;
  const PictureView& view_;
  std::array<int, 2> size_;
  const Progress& progress_;
  Volume result_;
  std::vector<Vec3> frame_;
};

}  // namespace

Picture stage_sheet(const Mission& mission, const std::vector<StageFile>& stages, const PictureView& view,
                    std::array<int, 2> size, const Progress& progress) {
  SheetMaker maker(mission, view, size, progress);
  maker.make(stages);
  return arrange_sheet(maker.panels, kColumns, mission.target.name, picture_subtitle(mission, nullptr) + maker.note);
}

}  // namespace vantage::cli
