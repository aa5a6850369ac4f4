// The page of `vantage report` for a mission and a volume that are in memory.
#pragma once

#include <memory>
#include <string>

#include "vantage/mission.h"
#include "vantage/progress.h"
#include "vantage/query.h"
#include "vantage/scene_source.h"

namespace vantage {

/// What is shown. The mission has one volume: see one_volume().
struct ViewerRequest {
  const Mission* mission = nullptr;
  const Volume* volume = nullptr;  ///< of that mission; closed
  std::shared_ptr<const LoadedScene>
      loaded;              ///< that the mission was resolved in; not its own, where it has more ground
  PreparedScene prepared;  ///< that scene
  SceneSource source;      ///< where it came from
  std::string name;        ///< what the page calls that file
  double rounding_m = 0;   ///< of the file that the volume was read from
  bool proves = false;     ///< it holds the verdict of the proof as well
};

/// `page`: the text of web/dist/report.html. Throws Error: page_missing for another text, mesh_not_closed.
std::string viewer_page(const ViewerRequest& request, const std::string& page, const Progress& progress = {});

}  // namespace vantage
