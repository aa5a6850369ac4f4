// The steps of the method of spheres, written down: `vantage compute --stages`.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "common/temporary_folder.h"
#include "vantage/export.h"
#include "vantage/mission.h"
#include "vantage/spheres.h"

namespace vantage {

/// A folder of numbered meshes (000_sphere_0.ply, scene frame) and stages.json. It is made under another name beside
/// its place, and put there by commit() as a whole; before that, and when anything fails, what was there stays. An
/// older folder is replaced only if it is empty, or holds a stages.json and nothing but files of such names.
class VANTAGE_API StageFolder {
 public:
  /// Throws Error(input) for a place that is taken by something else, Error(output) where no folder can be made.
  explicit StageFolder(std::filesystem::path folder);
  StageFolder(const StageFolder&) = delete;
  StageFolder& operator=(const StageFolder&) = delete;
  ~StageFolder();

  /// Valid as long as this object. Its calls throw Error(output).
  StageSink sink();

  /// Writes the story. Throws Error(output), and Error(input) when what is in the folder's place must not be replaced.
  void write_story(const Mission& mission, const Result& result);

  /// Puts the folder in its place: when all else is written. Throws as write_story().
  void commit();

 private:
  void add(const SphereStage& stage);
  void check_replaceable() const;
  [[noreturn]] void fail(const std::string& problem, int error_number) const;

  std::filesystem::path asked_, folder_;
  std::unique_ptr<TemporaryFolder> temporary_;
  struct Told {
    std::string kind, name, file;  // no file: there is no mesh, or it is empty
    std::vector<Vec3> points;
    long euler;
    std::vector<long> component_euler;
    double volume_m3, seconds;
  };
  std::vector<Told> stages_;
};

/// A step as `vantage compute --method spheres --stages` wrote it down.
struct StageFile {
  std::string kind;  ///< "sphere", "pair", "split", "partial", "result"
  std::string name;
  std::filesystem::path mesh;  ///< empty: the step has none
  long euler = 0;
};

/// Reads `folder`/stages.json. Throws Error(input) for a missing or garbled file, naming the stage.
VANTAGE_API std::vector<StageFile> read_stages(const std::filesystem::path& folder);

}  // namespace vantage
