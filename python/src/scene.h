// Scenes as Python holds them: loaded once, prepared once.
#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include "vantage/mission.h"
#include "vantage/scene_source.h"

namespace vantage::python {

/// Any number of threads may use one at once.
class PyScene {
 public:
  PyScene(std::shared_ptr<const LoadedScene> loaded, SceneSource source, std::optional<double> sea_level_m)
      : loaded_(std::move(loaded)), source_(std::move(source)), sea_level_m_(sea_level_m) {}

  const Scene& scene() const { return loaded_->scene; }
  const std::shared_ptr<const LoadedScene>& loaded() const { return loaded_; }
  SceneSource source() const {
    const std::lock_guard lock(source_mutex_);
    return source_;
  }
  void set_source(SceneSource source) {
    const std::lock_guard lock(source_mutex_);
    source_ = std::move(source);
  }
  std::optional<double> sea_level_m() const { return sea_level_m_; }

  /// Made when they are first asked for.
  PreparedScene prepared(const Progress& progress = {}) const;
  const std::string& hash() const;

 private:
  std::shared_ptr<const LoadedScene> loaded_;
  SceneSource source_;
  std::optional<double> sea_level_m_;
  mutable std::mutex source_mutex_, hash_mutex_;
  mutable std::recursive_mutex prepared_mutex_;  // who is told of progress may ask for the same scene
  mutable std::optional<PreparedScene> prepared_;
  mutable std::string hash_;
};

}  // namespace vantage::python
