// vantage: visibility volumes of convex polygons in city scenes.
#include <stdlib.h>

#include <algorithm>

#include "cli/program.h"

int main(int argument_count, char** arguments) {
  // GDAL may bring OpenBLAS, which nothing here uses: it starts threads while it is loaded, and waits for ever where
  // the system gives none.
  ::setenv("OPENBLAS_NUM_THREADS", "1", 0);
  return vantage::cli::run_program({arguments + std::min(argument_count, 1), arguments + argument_count});
}
