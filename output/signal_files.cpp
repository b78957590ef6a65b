#include "output/signal_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/errors.hpp"

namespace driftwright::output {
namespace {

using compensation::Counting, compensation::kLineA, compensation::kLineB, compensation::kLineIndex;

/// Rows that halstreamer may buffer ahead of the encoder.
constexpr std::int64_t kHalDepth = 16384;

std::ofstream open(const std::string& path) {
  std::ofstream file(path, std::ios::binary);
  if (!file) throw InputError(fmt::format("{}: cannot be written", path));
  return file;
}

void close(std::ofstream& file, const std::string& path) {
  file.close();
  if (!file) throw InputError(fmt::format("{}: not all could be written; is the disk full?", path));
}

struct Timescale {
  std::string words;
  std::int64_t ticks_per_row = 1;
};

Timescale timescale_for(double row_s) {
  const double row_ps = row_s * 1e12;
  if (!(row_ps >= 0.5 && row_ps < 1e18))
    throw InputError(fmt::format("a row lasts {} s; it must last 1 ps or longer", row_s));
  std::int64_t scale_ps = 1, ticks = std::llround(row_ps);
  while (ticks % 10 == 0 && scale_ps < 100'000'000'000'000) {
    ticks /= 10;
    scale_ps *= 10;
  }
  constexpr std::array<const char*, 5> kUnits = {"ps", "ns", "us", "ms", "s"};
  std::size_t unit = 0;
  for (; scale_ps >= 1000; scale_ps /= 1000) ++unit;
  return {fmt::format("{} {}", scale_ps, kUnits[unit]), ticks};
}

}  // namespace

VcdFile::VcdFile(const std::string& path, double row_s, bool has_index, const std::string& made_by)
    : path_(path), file_(open(path)), has_index_(has_index) {
  const Timescale scale = timescale_for(row_s);
  ticks_per_row_ = scale.ticks_per_row;
  most_rows_ = std::numeric_limits<std::int64_t>::max() / ticks_per_row_;
  file_ << "$comment " << made_by << " $end\n$timescale " << scale.words << " $end\n$scope module injector $end\n"
        << "$var wire 1 ! a_in $end\n$var wire 1 \" b_in $end\n$var wire 1 # a_out $end\n$var wire 1 $ b_out $end\n";
  if (has_index) file_ << "$var wire 1 % z_in $end\n$var wire 1 & z_out $end\n";
  file_ << "$upscope $end\n$enddefinitions $end\n";
}

void VcdFile::row(std::int64_t row, Lines in, Lines out) {
  const bool first = last_row_ < 0;
  const Lines in_changes = static_cast<Lines>(first ? 7 : in ^ last_in_);
  const Lines out_changes = static_cast<Lines>(first ? 7 : out ^ last_out_);
  if (row >= most_rows_)
    throw InputError(fmt::format("{}: row {} of {} ticks each is beyond a 64-bit time; take a rounder time of a row", path_,
                                 row + 1, ticks_per_row_));
  last_row_ = row;
  if (in_changes == 0 && out_changes == 0) return;
  std::string text = fmt::format("#{}\n", row * ticks_per_row_);
  if (first) text += "$dumpvars\n";
  const auto show = [&](Lines changes, Lines lines, Lines line, char id) {
    if (!(changes & line)) return;
    text += (lines & line) ? '1' : '0';
    text += id;
    text += '\n';
  };
  show(in_changes, in, kLineA, '!');
  show(in_changes, in, kLineB, '"');
  show(out_changes, out, kLineA, '#');
  show(out_changes, out, kLineB, '$');
  if (has_index_) {
    show(in_changes, in, kLineIndex, '%');
    show(out_changes, out, kLineIndex, '&');
  }
  if (first) text += "$end\n";
  file_ << text;
  last_in_ = in;
  last_out_ = out;
}

void VcdFile::finish() {
  if (last_row_ >= 0) file_ << fmt::format("#{}\n", (last_row_ + 1) * ticks_per_row_);
  close(file_, path_);
}

HalStreamFile::HalStreamFile(const std::string& path, bool has_index)
    : path_(path), file_(open(path)), has_index_(has_index) {}

void HalStreamFile::write(Lines lines) {
  ++n_rows_;
  x4_.step(lines);
  x1_.step(lines);
  const int a = lines & kLineA ? 1 : 0, b = lines & kLineB ? 1 : 0;
  file_ << (has_index_ ? fmt::format("{} {} {} {}\n", a, b, lines & kLineIndex ? 1 : 0, n_rows_)
                       : fmt::format("{} {} {}\n", a, b, n_rows_));
}

void HalStreamFile::row(Lines lines) {
  if (n_rows_ == 0) {
    const int phase = compensation::phase_of(lines);
    const int way = phase == 3 ? -1 : phase;
    for (Lines step : compensation::motion_rows(0, way - (way > 0) + (way < 0))) write(step);
  }
  write(lines);
}

void HalStreamFile::finish() {
  close(file_, path_);
}

std::int64_t HalStreamFile::expected_count(Counting counting) const {
  return counting == Counting::kX1 ? x1_.count() : x4_.count();
}

std::string hal_text(const std::string& stream_path, const HalStreamFile& stream, bool has_index, Counting counting,
                     const std::string& made_by) {
  const int last = has_index ? 3 : 2;
  std::string text = fmt::format(
      "# {}\n"
      "# Plays {} into LinuxCNC's encoder, one row a millisecond: halrun -f THIS_FILE\n"
      "# streamer.0.pin.{} shows the row that has been played; after row {} encoder.0.rawcounts is {}.\n"
      "loadrt streamer depth={} cfg={}\n"
      "loadrt encoder num_chan=1\n"
      "loadrt threads name1=fast period1=1000000\n"
      "addf streamer.0 fast\n"
      "addf encoder.update-counters fast\n"
      "addf encoder.capture-position fast\n"
      "net encoder-a streamer.0.pin.0 => encoder.0.phase-A\n"
      "net encoder-b streamer.0.pin.1 => encoder.0.phase-B\n",
      made_by, stream_path, last, stream.n_rows(), stream.expected_count(counting), kHalDepth, has_index ? "bbbu" : "bbu");
  if (has_index) text += "net encoder-z streamer.0.pin.2 => encoder.0.phase-Z\n";
  text += fmt::format(
      "setp encoder.0.x4-mode {}\n"
      "start\n"
      "loadusr -w halstreamer {}\n"
      "loadusr -w sleep {}\n"
      "show pin encoder.0.rawcounts\n"
      "show pin streamer.0.pin.{}\n",
      counting == Counting::kX4 ? 1 : 0, stream_path, std::min<std::int64_t>(stream.n_rows(), kHalDepth) / 1000 + 2, last);
  return text;
}

}  // namespace driftwright::output
