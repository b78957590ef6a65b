#include "nc/positions.hpp"

#include <algorithm>
#include <cmath>
#include <string>

namespace driftwright {
namespace {

constexpr double kRoundingOfRows = 1e-9;  // of a row: durations are sums

/// The range of the axes within a piece of time.
struct AxesRange {
  double duration_s = 0.0;
  std::array<double, 3> low_m, high_m;

  void take(const AxesRange& other) {
    for (std::size_t a = 0; a < 3; ++a) {
      low_m[a] = duration_s > 0.0 ? std::min(low_m[a], other.low_m[a]) : other.low_m[a];
      high_m[a] = duration_s > 0.0 ? std::max(high_m[a], other.high_m[a]) : other.high_m[a];
    }
    duration_s += other.duration_s;
  }
};

/// The range of the axes in a share of a straight move.
AxesRange straight_piece(double duration_s, const std::array<double, 3>& from_m, const std::array<double, 3>& to_m,
                         double begin, double end) {
  AxesRange piece{duration_s * (end - begin), {}, {}};
  for (std::size_t a = 0; a < 3; ++a) {
    const double x = from_m[a] + begin * (to_m[a] - from_m[a]), y = from_m[a] + end * (to_m[a] - from_m[a]);
    piece.low_m[a] = std::min(x, y);
    piece.high_m[a] = std::max(x, y);
  }
  return piece;
}

}  // namespace

std::vector<Cyclogram::Column> position_columns(const NcProgram& program, double resolution_s,
                                                const std::array<double, 3>& origin_m) {
  std::vector<Cyclogram::Column> columns;
  for (const char axis : {'x', 'y', 'z'}) {
    columns.push_back({std::string("position_") + axis, "mm", {}});
    columns.push_back({std::string("stroke_") + axis, "mm", {}});
  }
  double time_s = 0.0;
  AxesRange row{0.0, {}, {}};
  const auto flush = [&] {
    if (!(row.duration_s > 0.0)) return;
    for (std::size_t a = 0; a < 3; ++a) {
      for (const std::size_t c : {2 * a, 2 * a + 1}) columns[c].rows.time_s.push_back(time_s);
      columns[2 * a].rows.value.push_back(1e3 * (0.5 * (row.low_m[a] + row.high_m[a]) - origin_m[a]));
      columns[2 * a + 1].rows.value.push_back(1e3 * (row.high_m[a] - row.low_m[a]));
    }
    time_s += row.duration_s;
    row = {0.0, {}, {}};
  };
  const auto add = [&](const AxesRange& piece) {
    if (!(piece.duration_s > 0.0)) return;
    row.take(piece);
    if (row.duration_s >= resolution_s) flush();
  };

  std::array<double, 3> at_m = {0.0, 0.0, 0.0}, shift_m = {0.0, 0.0, 0.0};  // in the first work offset; of the origin since
  for (const NcStep& step : program.steps) {
    std::array<double, 3> to_m = at_m;
    const NcDemand& demand = step.demand;
    for (std::size_t a = 0; a < 3; ++a) {
      if (!step.moves()) shift_m[a] += step.end_m[a] - step.start_m[a];  // the program has only renamed the place
      if (demand.low_m[a] == demand.high_m[a]) shift_m[a] = step.end_m[a] - demand.low_m[a];
      if (step.moves()) to_m[a] = step.end_m[a] - shift_m[a];
    }
    const bool is_straight = step.kind == NcStepKind::kLine || step.kind == NcStepKind::kRapid;
    const double duration_s = step.duration_s();
    const double rows = resolution_s > 0.0 ? std::ceil(duration_s / resolution_s - kRoundingOfRows) : 1.0;
    if (is_straight && rows > 1.0) {
      const int n = static_cast<int>(rows);
      flush();
      for (int i = 0; i < n; ++i) {
        row.take(straight_piece(duration_s, at_m, to_m, static_cast<double>(i) / n, static_cast<double>(i + 1) / n));
        flush();
      }
    } else {
      AxesRange piece = straight_piece(duration_s, at_m, to_m, 0.0, 1.0);
      for (std::size_t a = 0; a < 3; ++a) {  // an arc reaches beyond its ends, a canned cycle goes down and up
        piece.low_m[a] = std::min(piece.low_m[a], demand.low_m[a]);
        piece.high_m[a] = std::max(piece.high_m[a], demand.high_m[a]);
      }
      add(piece);
    }
    at_m = to_m;
  }
  flush();
  return columns;
}

}  // namespace driftwright
