#include "findings/identification_document.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace driftwright::findings {
namespace {

using identification::Driver, identification::Identified, identification::IdentifiedBody, identification::IdentifiedChannel;
using output::significant;

constexpr double kWorthSaying = 0.02;  // smallest share of a driver that is mentioned

std::string shown(const std::string& unit) {
  return unit == "um" ? "µm" : unit == "urad" ? "µrad" : "K";
}

std::string time_text(double s) {
  if (s < 90.0) return fmt::format("{:.0f} s", s);
  return s < 36000.0 ? fmt::format("{:.0f} min", s / 60.0) : fmt::format("{:.1f} h", s / 3600.0);
}

/// "96 % while speed is not 0, 10.5 K in the end, 40 min; 4 % ambient".
std::string ledger_text(const std::vector<Driver>& drivers, const IdentifiedChannel& c) {
  std::vector<std::string> parts;
  for (const Driver& d : drivers) {
    if (std::abs(d.share) < kWorthSaying) continue;
    if (d.delay_s == 0.0 && d.in_the_end == 0.0) {
      parts.push_back(fmt::format("{:.0f} % {}", 100.0 * d.share, d.name));
      continue;
    }
    parts.push_back(fmt::format("{:.0f} % {} ({:+.3g} {}{}, {})", 100.0 * d.share, d.name, d.in_the_end, shown(c.unit),
                                d.name == "ambient" ? " for 1 K" : " in the end", time_text(d.delay_s)));
  }
  return parts.empty() ? "follows nothing recorded" : fmt::format("{}", fmt::join(parts, "; "));
}

/// The same of what the scenario misses, and what is left of it: "80 % while speed is not 0 (...); 20 % left: 2.7 µm, 9.1
/// times the noise".
std::string missing_text(const IdentifiedChannel& c) {
  std::vector<Driver> drivers = c.missing;
  std::erase_if(drivers, [](const Driver& d) { return d.name == identification::kLeft; });
  double left = 1.0;
  for (const Driver& d : drivers) left -= d.share;
  const std::string learned = c.is_extended ? ledger_text(drivers, c) + "; " : "";
  const std::string noise = c.noise > 0.0 ? fmt::format(", {:.2g} times the noise", c.missed_own / c.noise) : "";
  return fmt::format("{}{:.0f} % left: {:.3g} {}{}", learned, 100.0 * left, c.missed_own, shown(c.unit), noise);
}

std::string heated_by(const IdentifiedBody& b, const Identified& n) {
  if (!b.body.law) return "ambient alone";
  const identification::Law& law = n.structure.laws[*b.body.law];
  switch (law.kind) {
    case identification::Law::Kind::kTurning:
      return fmt::format("{} not 0", law.channel);
    case identification::Law::Kind::kPower:
      return fmt::format("{}^{:.3g}", law.channel, law.exponent);
    case identification::Law::Kind::kColumn:
      break;
  }
  return law.channel;
}

output::Table channels_table(const Identified& n) {
  output::Table table{.key = "channels",
                      .title = "What is left of each channel",
                      .caption =
                          "Root mean square of measured less computed, driven by what was recorded and by no reading. Own "
                          "rows: how warm each record begins and where its indicators are at zero are fitted with it. As "
                          "simulated: of the written scenario, which begins in balance with "
                          "the first ambient; much more than that says that a record begins warm. Kept "
                          "out: rows that a network was not fitted to, of each kind in turn (runs or eighths, speeds, the "
                          "end, the beginning, the warmest and the coldest rows), geometric "
                          "mean over the kinds; the structure of the network was chosen by these rows, so that rows of "
                          "another day may be missed by more.",
                      .columns = {{.key = "name", .title = "channel"},
                                  {.key = "unit", .title = "unit"},
                                  {.key = "deviation", .title = "standard deviation", .digits = significant(3)},
                                  {.key = "rms_own", .title = "left, own rows", .digits = significant(3)},
                                  {.key = "rms_simulated", .title = "as simulated", .digits = significant(3)},
                                  {.key = "rms_kept_out", .title = "left, kept out", .digits = significant(3)}}};
  for (const auto& kind : n.kinds)
    table.columns.push_back({.key = "rms_" + kind.kind, .title = kind.kind, .digits = significant(3)});
  for (std::size_t c = 0; c < n.channels.size(); ++c) {
    const IdentifiedChannel& channel = n.channels[c];
    table.rows.push_back({channel.name, shown(channel.unit), channel.swing, channel.missed_own, channel.missed_simulated,
                          channel.missed_kept_out});
    for (const auto& kind : n.kinds) table.rows.back().emplace_back(kind.rms[c]);
  }
  return table;
}

output::Table extension_table(const Identified& n) {
  output::Table table{
      .key = "channels",
      .title = "What the scenario leaves of each channel, and with what was learned",
      .caption =
          "Root mean square of measured less simulated, driven by what was recorded and by no reading. As simulated: all "
          "rows of the records, by the file that was read and the one that was written. Kept out: rows that were "
          "hidden from what was learned, of each kind in turn, geometric mean over the kinds; the scenario's own "
          "numbers, wherever they come from, were as they are in all of them. Regression: a plain regression on drive and "
          "ambient after lags, fitted to what each part leaves; it knows neither zeros nor starts of single records. Noise: "
          "of the readings. Missed more without: mean over the "
          "hidden parts, and its standard error; what is not above 0 with 95 % (Student) is not written. Kept: share of the "
          "scenario's own change.",
      .columns = {{.key = "name", .title = "channel"},
                  {.key = "unit", .title = "unit"},
                  {.key = "rms_scenario", .title = "scenario, as simulated", .digits = significant(3)},
                  {.key = "rms_simulated", .title = "extended, as simulated", .digits = significant(3)},
                  {.key = "rms_scenario_kept_out", .title = "scenario, kept out", .digits = significant(3)},
                  {.key = "rms_kept_out", .title = "extended, kept out", .digits = significant(3)},
                  {.key = "rms_regression_kept_out", .title = "regression, kept out", .digits = significant(3)},
                  {.key = "noise", .title = "noise", .digits = significant(2)},
                  {.key = "missed_more_without", .title = "missed more without", .unit = "%", .digits = output::percent(0)},
                  {.key = "standard_error", .title = "standard error", .unit = "%", .digits = output::percent(0)},
                  {.key = "kept", .title = "kept", .unit = "%", .digits = output::percent(0)},
                  {.key = "written", .title = "learned"}}};
  for (const IdentifiedChannel& c : n.channels)
    table.rows.push_back({c.name, shown(c.unit), c.scenario_simulated, c.missed_simulated, c.scenario_kept_out,
                          c.missed_kept_out, c.regression_kept_out, c.noise, std::expm1(c.missed_more_without.mean),
                          c.missed_more_without.standard_error, c.fit.kept, c.is_extended ? "yes" : "no"});
  return table;
}

output::Table bodies_table(const Identified& n) {
  output::Table table{
      .key = "bodies",
      .title = "Bodies",
      .caption =
          "Each loses heat to the ambient alone. Rise: over the ambient in the end, at the largest drive that was recorded; "
          "it is a scale that sensitivities go with. Missed: by "
          "how much more kept-out rows are missed without it (the time constants of the others as they are); empty for the "
          "ambient's part of a heated body.",
      .columns = {{.key = "name", .title = "body"},
                  {.key = "heated_by", .title = "warmed by"},
                  {.key = "time_constant_min", .title = "time constant", .unit = "min", .digits = significant(3)},
                  {.key = "rise_K", .title = "rise", .unit = "K", .digits = significant(3)},
                  {.key = "missed_share", .title = "missed", .unit = "%", .digits = output::percent(1)}}};
  for (const IdentifiedBody& b : n.bodies)
    table.rows.push_back({b.name, heated_by(b, n), b.body.tau_s / 60.0, b.body.rise_K, b.gain});
  return table;
}

output::Table weights_table(const Identified& n) {
  output::Table table{.key = "weights",
                      .title = "What channels see of the bodies",
                      .caption =
                          "Of thermometers the share of each body in the mean that they read; of displacements µm for each "
                          "K. Standard deviation: of the heated part.",
                      .columns = {{.key = "channel", .title = "channel"},
                                  {.key = "body", .title = "body"},
                                  {.key = "weight", .title = "share, or µm/K", .digits = significant(4)},
                                  {.key = "standard_deviation", .title = "standard deviation", .digits = significant(2)}},
                      .detail = true};
  for (const IdentifiedChannel& c : n.channels) {
    for (std::size_t b = 0; b < n.bodies.size(); ++b) {
      const auto at = static_cast<Eigen::Index>(b);
      if (c.fit.weight[at] == 0.0) continue;
      table.rows.push_back({c.name, n.bodies[b].name, c.fit.weight[at],
                            c.fit.covariance(at, at) > 0.0 ? std::sqrt(c.fit.covariance(at, at)) : std::nan("")});
    }
    if (c.fit.of_ambient > 0.0) table.rows.push_back({c.name, "ambient", c.fit.of_ambient, std::nan("")});
  }
  return table;
}

output::Table ledger_table(const Identified& n) {
  output::Table table{.key = "ledger",
                      .title = "Ledger: what drives each channel",
                      .caption =
                          "Share of what the network gives of the channel's variance. Swing: largest less smallest in the "
                          "records. In the end: of the largest drive recorded, held for "
                          "ever; of the ambient for 1 K. Delay: until 63 % of the largest that a step comes to.",
                      .columns = {{.key = "channel", .title = "channel"},
                                  {.key = "driver", .title = "driver"},
                                  {.key = "share", .title = "share", .unit = "%", .digits = output::percent(0)},
                                  {.key = "swing", .title = "swing", .digits = significant(3)},
                                  {.key = "in_the_end", .title = "in the end", .digits = significant(3)},
                                  {.key = "unit", .title = "unit"},
                                  {.key = "delay_min", .title = "delay", .unit = "min", .digits = significant(3)}},
                      .detail = true};
  for (const IdentifiedChannel& c : n.channels) {
    for (const Driver& d : c.ledger)
      table.rows.push_back({c.name, d.name, d.share, d.swing, d.in_the_end, shown(c.unit), d.delay_s / 60.0});
  }
  return table;
}

/// Times of the rows that are used, records one after the other [h].
std::vector<double> hours(const Identified& n, const std::vector<Record>& records) {
  std::vector<double> time_h;
  double before_h = 0.0;
  for (std::size_t r = 0; r < records.size(); ++r) {
    for (std::size_t i = 0; i < records[r].n_samples() / n.blocks[r]; ++i)
      time_h.push_back(before_h + (records[r].time_s[i * n.blocks[r]] - records[r].time_s[0]) / 3600.0);
    before_h = time_h.back() + 0.1;
  }
  return time_h;
}

output::Verdict verdict_of_network(const Identified& n) {
  double own = 0.0, kept = 0.0, count = 0.0;
  for (const IdentifiedChannel& c : n.channels) {
    if (!(c.swing > 0.0) || !std::isfinite(c.missed_kept_out)) continue;
    own += std::log(c.missed_own / c.swing);
    kept += std::log(c.missed_kept_out / c.swing);
    count += 1.0;
  }
  const double share = std::exp(kept / std::max(count, 1.0));
  return {.kind = share < 0.5 ? output::Verdict::Kind::kGood : output::Verdict::Kind::kBad,
          .title = fmt::format("{} bodies leave {:.0f} % of the measured variation on rows that were kept out of the fit, "
                               "{:.0f} % on the rows of the fit",
                               n.bodies.size(), 100.0 * share, 100.0 * std::exp(own / std::max(count, 1.0))),
          .text = share < 0.5 ? "The percentage is the RMS error of a channel divided by its standard deviation, as "
                                "geometric mean over the channels."
                              : "Drive and ambient that were recorded explain less than half: something else drives "
                                "this machine, or the record holds too few changes of the drive."};
}

output::Verdict verdict_of_extension(const Identified& n) {
  double left = 0.0, count = 0.0, n_extended = 0.0, regression = 0.0, n_better = 0.0;
  for (const IdentifiedChannel& c : n.channels) {
    n_extended += c.is_extended ? 1.0 : 0.0;
    if (!(c.scenario_kept_out > 0.0) || !std::isfinite(c.missed_kept_out)) continue;
    left += std::log(c.missed_kept_out / c.scenario_kept_out);
    count += 1.0;
    if (c.regression_kept_out > 0.0) regression += std::log(c.regression_kept_out / c.scenario_kept_out);
    n_better += c.missed_kept_out <= c.regression_kept_out ? 1.0 : 0.0;
  }
  const std::string beside = fmt::format(
      " A plain regression on the same drives and ambient leaves {:.0f} % and predicts {:.0f} of {:.0f} channels "
      "better.",
      100.0 * std::exp(regression / std::max(count, 1.0)), count - n_better, count);
  if (n_extended == 0.0)
    return {
        .kind = output::Verdict::Kind::kGood,
        .title = "Nothing is learned: the scenario is written as it is",
        .text =
            std::string(
                "What drive and ambient explain beyond it does not last on rows that were kept out. What it still misses "
                "follows something that was not recorded, or is noise.") +
            beside};
  return {
      .kind = output::Verdict::Kind::kGood,
      .title = fmt::format("{:.0f} of {} channels are extended; {:.0f} % of what the scenario misses on rows that were kept "
                           "out is left",
                           n_extended, n.channels.size(), 100.0 * std::exp(left / std::max(count, 1.0))),
      .text =
          std::string(
              "Geometric mean over the channels. What was learned follows the drives and the ambient that were recorded, "
              "within their range; no promise is made beyond it.") +
          beside};
}

}  // namespace

output::Document document_of(const IdentificationFindings& found, const output::Provenance& made_by) {
  const Identified& n = found.network;
  std::vector<std::string> sources;
  for (const Record& r : found.records) sources.push_back(r.source);
  output::Document document{.made_by = made_by,
                            .title = found.name + (n.is_extension ? ": what the scenario misses, learned beside it"
                                                                  : ": a network from records alone"),
                            .subtitle = fmt::format("{}", fmt::join(sources, ", "))};
  output::Section& body = document.body;
  add(body, n.is_extension ? verdict_of_extension(n) : verdict_of_network(n));
  output::Table said{.key = "ledger_in_words",
                     .title = "What drives each channel",
                     .caption =
                         "Share of the variance that the network gives; what the largest drive that was recorded comes to "
                         "in the end, or 1 K of the ambient; until 63 % are there.",
                     .columns = {{.key = "name", .title = "channel"}, {.key = "driven_by", .title = "driven by"}}};
  if (n.is_extension) {
    said.caption +=
        " Missed: the same of what the scenario alone misses on the rows of the fit, apart from how each record begins; "
        "left is what nothing recorded explains, as root mean square.";
    said.columns.push_back({.key = "missed", .title = "missed by the scenario"});
  }
  for (const IdentifiedChannel& c : n.channels) {
    said.rows.push_back({c.name, ledger_text(c.ledger, c)});
    if (n.is_extension) said.rows.back().emplace_back(missing_text(c));
  }
  add(body, std::move(said));
  add(body, n.is_extension ? extension_table(n) : channels_table(n));
  add(body, bodies_table(n));
  add(body, weights_table(n));
  add(body, ledger_table(n));
  add(body, output::Notes{.key = "guesses", .sort = "guess", .lines = n.roles.guesses});
  add(body, output::Notes{.key = "notes", .sort = "note", .lines = found.notes});
  if (n.is_extension) {
    add(body, output::Preformatted{.title = "Difference to the scenario",
                                   .text = found.difference.empty() ? "No difference to the scenario." : found.difference});
  }
  const std::vector<double> time_h = hours(n, found.records);
  for (const IdentifiedChannel& c : n.channels) {
    std::vector<double> predicted, measured;
    for (Eigen::Index i = 0; i < std::min<Eigen::Index>(c.predicted.size(), static_cast<Eigen::Index>(time_h.size())); ++i) {
      predicted.push_back(c.predicted[i]);
      measured.push_back(c.predicted[i] + c.misses[i]);
    }
    add(body, output::Plot{.title = c.name,
                           .x_label = "time [h], records one after the other",
                           .y_label = c.unit != "um" ? fmt::format("over {:.4g} degC [K]", n.reference_degC)
                                                     : "from the first reading [µm]",
                           .series = {{.label = "measured", .x = time_h, .y = measured},
                                      {.label = "the network", .x = time_h, .y = predicted}}});
  }
  return document;
}

}  // namespace driftwright::findings
