#include "common/viewer_page.h"

#include "live/page_text.h"
#include "live/report_page.h"
#include "live/session.h"

namespace vantage {

std::string viewer_page(const ViewerRequest& request, const std::string& page, const Progress& progress) {
  live::check_page(page, "page");
  live::Session session;
  session.show(request, progress);
  return live::report_page(session, page, request.proves, progress);
}

}  // namespace vantage
