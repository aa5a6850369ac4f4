#include "self_test.h"
namespace attack { bool self_test() { return true; } }
