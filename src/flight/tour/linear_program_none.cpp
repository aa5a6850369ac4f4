// Built without a solver of linear programs.
#include "flight/tour/linear_program.h"

namespace vantage::internal::flight::tour {

std::unique_ptr<LinearProgram> make_linear_program() { return nullptr; }

bool has_linear_programs() { return false; }

}  // namespace vantage::internal::flight::tour
