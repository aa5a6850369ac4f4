// Judgements as text, to send from one process to another.
#pragma once

#include <string>

#include "judge.h"

namespace attack {

std::string to_text(const Judgement& judgement);
Judgement from_text(const std::string& text);

}  // namespace attack
