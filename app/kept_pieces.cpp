#include "app/kept_pieces.hpp"

#include <fmt/format.h>

#include <cstdlib>

#include "app/results.hpp"
#include "base/version.hpp"
#include "effects/former_words.hpp"
#include "scenarios/reader/content_key.hpp"

namespace driftwright::app {
namespace {

namespace fs = std::filesystem;

/// A row of numbers that are read back to the last bit.
std::string row_of(std::size_t piece, const Pieces::Numbers& numbers) {
  std::string row = fmt::format("{}", piece);
  for (double number : numbers) row += fmt::format(",{}", number);
  return row;
}

Pieces::Numbers numbers_of(const std::string& row) {
  Pieces::Numbers numbers;
  for (std::size_t comma = row.find(','); comma != std::string::npos; comma = row.find(',', comma + 1))
    numbers.push_back(std::strtod(row.c_str() + comma + 1, nullptr));
  return numbers;
}

}  // namespace

KeptPieces::KeptPieces(const fs::path& target, const ShardOptions& options, const std::string& scenario, std::vector<std::string> words)
    : parts_(target.string() + ".parts"), shard_(read_shard(options.shard)), merges_(options.merge) {
  if (merges_ && !options.shard.empty()) throw InputError("--merge joins what all shards have written; leave out --shard");
  words.emplace_back(kVersion);
  identity_ = {scenarios::content_key({effects::read_scenario_tree(scenario)}, fs::path(scenario).parent_path(), words), "piece,numbers"};
  std::size_t n_damaged = 0;
  rows_ = output::find_rows(parts_, identity_, &n_damaged);
  if (n_damaged > 0)
    fmt::print(stderr, "note: {} piece{} in {} {} damaged and dropped\n", n_damaged, n_damaged == 1 ? "" : "s", shown_path(parts_),
               n_damaged == 1 ? "is" : "are");
}

Pieces KeptPieces::pieces() {
  Pieces pieces{.shard = shard_,
                .find = [this](std::size_t piece) { return find(piece); },
                .keep = [this](std::size_t piece, const Pieces::Numbers& numbers) { keep(piece, numbers); }};
  if (!shard_.is_all()) pieces.look_again = [this] { look_again(); };
  return pieces;
}

std::optional<Pieces::Numbers> KeptPieces::find(std::size_t piece) {
  const std::lock_guard guard(lock_);
  if (const auto row = rows_.find(piece); row != rows_.end()) return numbers_of(row->second);
  if (merges_)
    throw InputError(fmt::format("the work is not all in {} yet; let every shard end, run those that were cut short again, or leave out --merge to work "
                                 "out here what is missing",
                                 shown_path(parts_)));
  return std::nullopt;
}

void KeptPieces::keep(std::size_t piece, const Pieces::Numbers& numbers) {
  const std::lock_guard guard(lock_);
  const std::string row = row_of(piece, numbers);
  file().append(row);
  rows_.emplace(piece, row);
}

output::RowsUnderWay& KeptPieces::file() {
  if (file_) return *file_;
  file_.emplace(parts_, shard_.is_all() ? "pieces.csv" : fmt::format("pieces.{}of{}.csv", shard_.number, shard_.of), identity_);
  if (file_->dropped_stale()) fmt::print(stderr, "note: pieces of an earlier version of this scenario or of other options are dropped\n");
  return *file_;
}

void KeptPieces::look_again() {
  const std::lock_guard guard(lock_);
  rows_.merge(output::find_rows(parts_, identity_));
}

std::string KeptPieces::finish_shard(const std::string& command) {
  file().finish(output::find_rows(parts_, identity_));
  return fmt::format("shard {} of {} is in {}; when all shards are done: {} --merge\n", shard_.number, shard_.of, shown_path(parts_), command);
}

void KeptPieces::remove() {
  file_.reset();
  output::remove_rows(parts_);
}

}  // namespace driftwright::app
