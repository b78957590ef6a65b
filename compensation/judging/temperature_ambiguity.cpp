#include "compensation/judging/temperature_ambiguity.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "base/errors.hpp"

namespace driftwright::compensation {
namespace {

struct Point {
  double temperature;
  double displacement_um;
  double time_s;
};

/// A piece of a record between two samples in which |displacement| >= floor and keeps its sign.
struct Piece {
  std::size_t record;
  Point cold;  // cold.temperature <= warm.temperature
  Point warm;
};

Point between(const Point& a, const Point& b, double fraction) {
  return {std::lerp(a.temperature, b.temperature, fraction), std::lerp(a.displacement_um, b.displacement_um, fraction),
          std::lerp(a.time_s, b.time_s, fraction)};
}

/// Appends the parts of the segment from a to b at or beyond the floor, at most one per sign.
void clip(const Point& a, const Point& b, double floor_um, std::size_t record, std::vector<Piece>& pieces) {
  for (double sign : {1.0, -1.0}) {
    const double above_a = sign * a.displacement_um - floor_um;
    const double above_b = sign * b.displacement_um - floor_um;
    if (!(above_a >= 0.0 || above_b >= 0.0)) continue;  // also skips NaN
    const double crossing = above_a / (above_a - above_b);
    const Point p = above_a >= 0.0 ? a : between(a, b, crossing);
    const Point q = above_b >= 0.0 ? b : between(a, b, crossing);
    pieces.push_back(p.temperature <= q.temperature ? Piece{record, p, q} : Piece{record, q, p});
  }
}

std::vector<Piece> pieces_of(std::span<const Record> records, const std::string& temperature,
                             const std::string& displacement, double floor_um) {
  std::vector<Piece> pieces;
  for (std::size_t r = 0; r < records.size(); ++r) {
    const Channel& t = records[r].at(temperature);
    const Channel& d = records[r].at(displacement);
    if (d.unit != "um") {
      throw InputError(
          fmt::format("channel '{}' of {} is in {}; it must be in um", displacement, records[r].source, d.unit));
    }
    if (const std::string& unit = records.front().at(temperature).unit; t.unit != unit) {
      throw InputError(fmt::format("channel '{}' is in {} in {} but in {} in {}; give it one unit", temperature, unit,
                                   records.front().source, t.unit, records[r].source));
    }
    for (std::size_t i = 0; i + 1 < records[r].n_samples(); ++i) {
      const Point a{t.values[i], d.values[i], records[r].time_s[i]};
      const Point b{t.values[i + 1], d.values[i + 1], records[r].time_s[i + 1]};
      const bool complete = std::isfinite(a.temperature) && std::isfinite(b.temperature) &&
                            std::isfinite(a.displacement_um) && std::isfinite(b.displacement_um);
      if (complete) clip(a, b, floor_um, r, pieces);
    }
  }
  return pieces;
}

/// The displacements of one record at one temperature. Only the smallest and the largest |d| of either sign can belong
/// to the pair with the largest spread.
class Extremes {
 public:
  void add(const Point& p) {
    const std::size_t sign = p.displacement_um < 0.0 ? 2 : 0;
    std::optional<Point>& smallest = points_[sign];
    std::optional<Point>& largest = points_[sign + 1];
    if (!smallest || std::abs(p.displacement_um) < std::abs(smallest->displacement_um)) smallest = p;
    if (!largest || std::abs(p.displacement_um) > std::abs(largest->displacement_um)) largest = p;
  }
  [[nodiscard]] const std::array<std::optional<Point>, 4>& points() const { return points_; }

 private:
  std::array<std::optional<Point>, 4> points_;
};

double spread_of(const Point& p, const Point& q) {
  return std::abs(p.displacement_um - q.displacement_um) /
         std::min(std::abs(p.displacement_um), std::abs(q.displacement_um));
}

}  // namespace

std::optional<TemperatureAmbiguity> temperature_ambiguity(std::span<const Record> records, const std::string& temperature,
                                                          const std::string& displacement, double floor_um) {
  if (!(floor_um > 0.0)) throw RangeError(fmt::format("the floor of {} um must be positive", floor_um));
  std::vector<Piece> pieces = pieces_of(records, temperature, displacement, floor_um);
  std::sort(pieces.begin(), pieces.end(),
            [](const Piece& a, const Piece& b) { return a.cold.temperature < b.cold.temperature; });
  std::vector<double> levels;
  for (const Piece& piece : pieces) {
    levels.push_back(piece.cold.temperature);
    levels.push_back(piece.warm.temperature);
  }
  std::sort(levels.begin(), levels.end());
  levels.erase(std::unique(levels.begin(), levels.end()), levels.end());

  std::optional<TemperatureAmbiguity> worst;
  std::vector<Piece> active;  // the pieces that cross the level
  auto next = pieces.begin();
  for (double level : levels) {
    while (next != pieces.end() && next->cold.temperature <= level) active.push_back(*next++);
    std::erase_if(active, [&](const Piece& piece) { return piece.warm.temperature < level; });

    std::vector<Extremes> at_level(records.size());
    for (const Piece& piece : active) {
      const double width = piece.warm.temperature - piece.cold.temperature;
      if (width > 0.0) {
        at_level[piece.record].add(between(piece.cold, piece.warm, (level - piece.cold.temperature) / width));
      } else {
        at_level[piece.record].add(piece.cold);
        at_level[piece.record].add(piece.warm);
      }
    }
    for (std::size_t r = 0; r < records.size(); ++r) {
      for (std::size_t s = r + 1; s < records.size(); ++s) {
        for (const std::optional<Point>& p : at_level[r].points()) {
          for (const std::optional<Point>& q : at_level[s].points()) {
            if (!p || !q || (worst && !(spread_of(*p, *q) > worst->spread))) continue;
            worst = TemperatureAmbiguity{.temperature = level,
                                         .first = {records[r].source, p->time_s, p->displacement_um},
                                         .second = {records[s].source, q->time_s, q->displacement_um},
                                         .spread = spread_of(*p, *q)};
          }
        }
      }
    }
  }
  return worst;
}

}  // namespace driftwright::compensation
