// What the commands that judge a volume for a mission have in common.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "cli/command.h"
#include "cli/progress_line.h"
#include "vantage/mission.h"
#include "vantage/result.h"

namespace vantage::cli {

struct JudgeArguments {
  CommonOptions common;
  std::string mission_file, volume_file, target;
  bool json = false;
};

/// Options into `arguments`, which must outlive the parsing.
void add_judge_options(CLI::App& command, JudgeArguments& arguments);

struct JudgedVolume {
  Mission mission;  ///< of the target that the volume is for
  VolumeFile read;
};

/// Reads both. Unless told to be quiet, prints what is to be known of them.
JudgedVolume read_judged(const JudgeArguments& arguments, ProgressLine& progress);

}  // namespace vantage::cli
