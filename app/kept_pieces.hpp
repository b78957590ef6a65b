#pragma once
// Keeps finished pieces of a verb's work in `<folder>.parts`, beside its folder of results: a run that was killed
// continues where it stopped, each shard keeps its own pieces, and the last run merges them.

#include <filesystem>
#include <mutex>
#include <optional>

#include "app/verbs.hpp"
#include "base/pieces.hpp"
#include "output/rows_under_way.hpp"

namespace driftwright::app {

class KeptPieces {
 public:
  /// Reads the pieces that are kept. The file of this shard is created and locked with the first piece that it keeps:
  /// work that is refused leaves no file.
  /// @param target  folder of results
  /// @param scenario, words  what determines the pieces: the scenario's path, and every option that changes the work
  /// @throws InputError  for an invalid shard, and for --merge together with --shard. Keeping a piece throws one when
  /// another process works at the same shard
  KeptPieces(const std::filesystem::path& target, const ShardOptions& options, const std::string& scenario,
             std::vector<std::string> words);
  KeptPieces(const KeptPieces&) = delete;
  KeptPieces& operator=(const KeptPieces&) = delete;

  /// The hooks for the work; this object must outlive them. With --merge, a missing piece is an InputError.
  [[nodiscard]] Pieces pieces();
  [[nodiscard]] const Shard& shard() const { return shard_; }
  /// Ends a shard: gives its file the final name. @param command  the command that merges, in words
  /// @returns the line for the terminal
  [[nodiscard]] std::string finish_shard(const std::string& command);
  /// Removes the kept pieces; call it once the results are written.
  void remove();

 private:
  [[nodiscard]] std::optional<Pieces::Numbers> find(std::size_t piece);
  void keep(std::size_t piece, const Pieces::Numbers& numbers);
  void look_again();
  [[nodiscard]] output::RowsUnderWay& file();

  std::filesystem::path parts_;
  Shard shard_;
  bool merges_ = false;
  output::RowsIdentity identity_;
  std::mutex lock_;
  output::NumberedRows rows_;
  std::optional<output::RowsUnderWay> file_;
};

}  // namespace driftwright::app
