#include <fmt/format.h>
#include <fmt/ranges.h>

#include "follow/json_words.hpp"
#include "follow/session.hpp"

namespace driftwright::follow {
namespace {

std::string list_of(const std::vector<std::string>& texts) {
  std::vector<std::string> all;
  for (const std::string& text : texts) all.push_back(quoted(text));
  return fmt::format("[{}]", fmt::join(all, ","));
}

std::string number_or_null(const std::optional<double>& x) {
  return x ? number(*x) : "null";
}

std::string probing_text(const ProbingState& p) {
  std::string text = fmt::format(R"({{"residual_um":{},"deviation_um":{},"refused":{})", number(p.residual_um),
                                 number(p.deviation_um), p.n_refused);
  std::vector<std::string> weights;
  for (const auto& [name, weight] : p.weights) weights.push_back(fmt::format("{}:{:.4g}", quoted(name), weight));
  if (!weights.empty()) text += fmt::format(R"(,"weights":{{{}}})", fmt::join(weights, ","));
  if (p.answer) {
    const ProbingAnswer& a = *p.answer;
    text += fmt::format(R"(,"is_taken":{},"off_um":{},"bound_um":{},"words":{})", a.is_taken, number(a.off_um),
                        number(a.bound_um), quoted(a.words));
    std::vector<std::string> list;
    for (const auto& [in, um] : a.intervals_um) list.push_back(fmt::format("{}:{}", quoted(in), number(um)));
    if (!list.empty()) text += fmt::format(R"(,"interval_95_um_in":{{{}}})", fmt::join(list, ","));
  }
  if (!p.probe_now.empty()) text += fmt::format(R"(,"probe_now":{})", quoted(p.probe_now));
  return text + "}";
}

}  // namespace

std::string line_text(const FollowLine& l) {
  std::string axes;
  for (const AxisCorrection& a : l.axes) {
    axes += fmt::format(R"({}{}:{{"correction_um":{},"interval_95_um":{},"trust":{},"predicted_um":{})",
                        axes.empty() ? "" : ",", quoted(a.name), number(a.correction_um), number_or_null(a.interval_um),
                        number(a.trust), number(a.predicted_um));
    if (a.deviation_um) axes += fmt::format(R"(,"deviation_um":{})", number(*a.deviation_um));
    if (!a.verdict.empty()) axes += fmt::format(R"(,"verdict":{})", quoted(a.verdict));
    if (a.watch_level) axes += fmt::format(R"(,"watch_level":{:.4g})", *a.watch_level);
    if (!a.alarm.empty()) axes += fmt::format(R"(,"alarm":{})", quoted(a.alarm));
    if (a.probing) axes += fmt::format(R"(,"probing":{})", probing_text(*a.probing));
    axes += fmt::format(R"(,"doubted":{}}})", list_of(a.doubted));
  }
  std::string text =
      fmt::format(R"({{"time_s":{},"run_s":{},"state":{})", l.time_s ? fmt::format("{:.12g}", *l.time_s) : "null",
                  l.run_s ? fmt::format("{:.12g}", *l.run_s) : "null", quoted(l.state));
  if (!l.why.empty()) text += fmt::format(R"(,"why":{})", quoted(l.why));
  text += fmt::format(R"(,"axes":{{{}}})", axes);
  if (!l.faults.empty()) text += fmt::format(R"(,"faults":{})", list_of(l.faults));
  return text + "}";
}

}  // namespace driftwright::follow
