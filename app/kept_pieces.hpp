#pragma once
// Pieces of a verb's work beside its folder of results, in `<folder>.parts`: a run that was killed goes on where it was, shards each keep their own, and
// the last run puts all together.

#include <filesystem>
#include <mutex>
#include <optional>

#include "app/verbs.hpp"
#include "base/pieces.hpp"
#include "output/rows_under_way.hpp"

namespace driftwright::app {

class KeptPieces {
 public:
  /// Looks at what is kept. The file of this shard is made and locked with the first piece that it keeps: work that is refused leaves nothing.
  /// @param target  folder of results
  /// @param scenario, words  what decides the pieces: its path, and every option that is said of the work
  /// @throws InputError  for shards that are none, for --merge beside --shard. Keeping throws one when another process works at the same shard
  KeptPieces(const std::filesystem::path& target, const ShardOptions& options, const std::string& scenario, std::vector<std::string> words);
  KeptPieces(const KeptPieces&) = delete;
  KeptPieces& operator=(const KeptPieces&) = delete;

  /// As the work wants them; this outlives it. With --merge, what is missing is an InputError.
  [[nodiscard]] Pieces pieces();
  [[nodiscard]] const Shard& shard() const { return shard_; }
  /// A shard is done: its file is put in its place. @returns what the terminal says. @param command  that merges, in words
  [[nodiscard]] std::string finish_shard(const std::string& command);
  /// Results stand: what was kept goes.
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
