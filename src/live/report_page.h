// A page for others: a volume to turn and look at, with what is known of it, in one file that needs no program.
#pragma once

#include <string>

#include "live/session.h"
#include "vantage/progress.h"

namespace vantage::live {

/// `page`: text of web/dist/report.html. What it holds: hello() and the volume of the session, which must have one;
/// with `proves` the verdict of the proof as well. Throws Error(page_missing) for another page.
std::string report_page(Session& session, const std::string& page, bool proves, const Progress& progress = {});

}  // namespace vantage::live
