// Tours of vehicles that cannot stop: Dubins paths from view to view.
#pragma once

#include "core/progress_reporter.h"
#include "vantage/tour.h"

namespace vantage::internal::flight::tour {

/// plan_tour for a fixed wing, of a request that has been checked. Headings and positions are chosen together: some
/// views of each target are drawn, a dynamic program over an order chooses among them (a generalised travelling
/// salesman problem of one order, as P. Vana and J. Faigl, "On the Dubins travelling salesman problem with
/// neighborhoods", 2015), then each view is moved and turned while that shortens the tour.
Tour plan_wing_tour(const TourRequest& request, const core::ProgressReporter& progress);

}  // namespace vantage::internal::flight::tour
