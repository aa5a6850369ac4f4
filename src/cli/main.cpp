// vantage: visibility volumes of convex polygons in city scenes.
#include <algorithm>

#include "cli/program.h"

int main(int argument_count, char** arguments) {
  return vantage::cli::run_program({arguments + std::min(argument_count, 1), arguments + argument_count});
}
