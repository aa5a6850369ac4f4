// vantage: visibility volumes of convex polygons in city scenes.
#include <stdlib.h>
#include <sys/auxv.h>

#include <algorithm>
#include <filesystem>
#include <system_error>

#include "cli/program.h"
#include "common/resources.h"

namespace {

/// A package that may lie anywhere brings its fonts and PROJ's database along, in PREFIX/share/vantage.
void use_resources_beside_program() {
  namespace fs = std::filesystem;
  std::error_code error;
  fs::path program = fs::read_symlink("/proc/self/exe", error);
  if (error) {  // no /proc: the name that the program was started by
    const auto name = getauxval(AT_EXECFN);
    if (name == 0) return;
    program = fs::canonical(reinterpret_cast<const char*>(name), error);
    if (error) return;
  }
  const fs::path folder = program.parent_path().parent_path() / "share/vantage";
  if (fs::is_directory(folder, error)) vantage::set_resource_folder(folder);
}

}  // namespace

int main(int argument_count, char** arguments) {
  // GDAL may bring OpenBLAS, which nothing here uses: it starts threads while it is loaded, and waits for ever where
  // the system gives none.
  ::setenv("OPENBLAS_NUM_THREADS", "1", 0);
  use_resources_beside_program();
  return vantage::cli::run_program({arguments + std::min(argument_count, 1), arguments + argument_count});
}
