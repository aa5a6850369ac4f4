// Missions as Python holds them: resolved in their scene.
#pragma once

#include <memory>

#include "scene.h"
#include "vantage/mission.h"

namespace vantage::python {

struct PyMission {
  std::shared_ptr<const PyScene>
      scene;  ///< that it was resolved in; not the mission's own, where its ground was extended
  std::shared_ptr<const Mission> mission;
  bool is_part = false;  ///< one of the volumes of a mission that has several: it still names all targets

  bool is_in_scene() const { return mission->loaded == scene->loaded(); }
  /// What is known of the scene already, for a run.
  RunOptions run_options(const Progress& progress) const;
  PreparedScene prepared(const Progress& progress) const;
  const Mission& operator*() const { return *mission; }
  const Mission* operator->() const { return mission.get(); }
};

}  // namespace vantage::python
