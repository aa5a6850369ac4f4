// What each limit must have in limit_rows_navigation.cpp or limit_rows_sensor.cpp: its row of the table, how it is
// moved, from what it is measured, when two are the same.
#pragma once

#include <functional>

#include "support/limit_samples.h"

namespace vantage::testing {

inline constexpr double kRangeOfDraws = 40;

using ChangeMesh = std::function<Mesh(const Mesh&)>;

template <Limit kLimit>
LimitSample sample_of();

template <Limit kLimit>
void move(LimitValueOf<kLimit>& limit, const Motion& motion);

template <Limit kLimit>
void change_soups_of(LimitValueOf<kLimit>& limit, const ChangeMesh& change);

template <Limit kLimit>
void expect_same(const LimitValueOf<kLimit>& found, const LimitValueOf<kLimit>& expected);

}  // namespace vantage::testing
