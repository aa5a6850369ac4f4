#include "cli/standard_streams.h"

#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <iostream>
#include <string_view>
#include <vector>

#include "cli/command.h"
#include "common/output.h"
#include "vantage/error.h"

namespace vantage::cli {

namespace {

const std::string& checked(const std::string& extension) {
  const std::vector<FormatFacts> formats = known_formats();
  const bool is_text = std::any_of(formats.begin(), formats.end(), [&](const FormatFacts& format) {
    return format.extension == extension && format.is_text;
  });
  if (!is_text && ::isatty(STDOUT_FILENO) == 1) {
    throw Error(ErrorCode::output_not_a_file, "standard output is a terminal, and a " + extension + " file is not text",
                "command line, -o", "send it to a program or a file: vantage ... -o - | PROGRAM");
  }
  return extension;
}

}  // namespace

MissionFile read_mission_argument(const std::string& argument) {
  if (!is_standard_stream(argument)) return read_mission(argument);
  constexpr std::streamsize kMost = std::streamsize{2} << 20;  // the parser takes half, and says so
  std::string text(static_cast<std::size_t>(kMost), '\0');
  std::cin.read(text.data(), kMost);
  if (std::cin.bad()) {
    throw Error(ErrorCode::file_unreadable, "the mission cannot be read", "standard input", "send it again");
  }
  text.resize(static_cast<std::size_t>(std::cin.gcount()));
  MissionFile mission = read_mission_text(text, "standard input");
  mission.file = "standard input";  // and not a file of that name in the current folder
  return mission;
}

OutgoingFile::OutgoingFile(const std::string& extension)
    : extension_(checked(extension)), path_(folder_.path() / ("result" + extension_)) {}

void OutgoingFile::send() const {
  std::ifstream stream(path_, std::ios::binary);
  std::string part(std::size_t{1} << 20, '\0');
  do {
    stream.read(part.data(), static_cast<std::streamsize>(part.size()));
    print(std::string_view{part}.substr(0, static_cast<std::size_t>(stream.gcount())));
  } while (stream);
  if (stream.bad() || !stream.eof()) {
    throw Error(ErrorCode::output_unwritable, "the result cannot be read back", path_.string(),
                "try again, or write to a file");
  }
}

}  // namespace vantage::cli
