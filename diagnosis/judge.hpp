#pragma once
// What claims make of kept-out rows: how likely these are with them, and by how much they are missed.

#include <map>
#include <memory>

#include "diagnosis/gain.hpp"
#include "diagnosis/kept_out_rows.hpp"
#include "diagnosis/plain_regression.hpp"

namespace driftwright::diagnosis {

/// Claims that are fitted together: a bit each.
using Subset = unsigned;

/// Of the folds of some rows; each subset of the claims is fitted once.
class Judge {
 public:
  /// All are loans for the judge's life.
  Judge(const Fitter& fitter, const SearchResult& result, const std::map<std::string, NoiseModel>& noise,
        std::vector<Fold> folds);

  /// What some of the claims make of the folds, all numbers fitted anew to the rows of each.
  struct Judged {
    std::vector<Prediction> predicted;  ///< of all runs, a fold each
    /// Logarithm of the probability of the kept-out rows, the fitted ones given, summed over the folds; up to what all claims share:
    /// the evidence of all rows less that of the fitted ones.
    double log_predictive = 0.0;
    std::vector<double> log_evidence = {};  ///< of the fitted rows of each fold
    Hypothesis hypothesis = {};
    std::vector<Eigen::VectorXd> x = {};  ///< of each fold's fit; empty where there is none
  };
  const Judged& judged(Subset claims);
  /// What a file that holds some claims, all numbers as fitted to a fold's rows, predicts of its kept-out ones. Of a run that is kept out whole nobody knows when
  /// something happens, as nobody would of one still to come: no window of time is open in it.
  [[nodiscard]] std::vector<Prediction> filed(Subset claims);
  /// The same as records still to come would be predicted: without what was found or fitted of single records, such as the offset of one's ambient.
  [[nodiscard]] std::vector<Prediction> filed_elsewhere(Subset claims);
  /// Least evidence of a claim in the fitted rows of a fold [nats, its price not paid]: what is known of it where some rows were never read.
  [[nodiscard]] double least_evidence(Subset claims, Subset without);
  /// What comes of the search made again without the kept-out rows; of a fold of blocks, in which something happened, what the claims make of it.
  struct Refound {
    std::vector<Prediction> extended, calibrated;
    std::vector<int>
        n_again;  ///< per claim: in how many of the searches the same effect was found at its place, or at one that its own is not told from
    int n_searched = 0;
  };
  [[nodiscard]] Refound refound(const SearchAgain& search_again, Subset kept, const Listener& listener);
  /// What regressions without a machine make of the folds.
  [[nodiscard]] std::vector<Prediction> regressed(Regressors regressors) const;
  [[nodiscard]] std::vector<Prediction> written() const { return std::vector<Prediction>(folds_.size(), written_); }

  /// Whether some claims miss kept-out rows by more than fewer of them do, and likelihood does not clearly say otherwise.
  [[nodiscard]] bool is_worse(Subset claims, Subset fewer);
  /// The same by a quarter of the squares, which speaks against the claims and not only against writing them: where numbers beyond what is known of them do what a claim
  /// does, both miss about as much.
  [[nodiscard]] bool is_much_worse(Subset claims, Subset fewer);

  /// Root mean square of kept-out misses over the noise of their channels.
  /// NaN where no row is kept out that could judge.
  [[nodiscard]] double over_noise(const std::vector<Prediction>& predicted) const;
  /// Squares of kept-out misses over those of noise, not whitened: what a user sees of them.
  [[nodiscard]] double squares_over_noise(const std::vector<Prediction>& predicted) const;
  enum class Of { kAll, kDisplacements };
  /// over_noise() of each fold, of all channels or of displacements alone.
  [[nodiscard]] std::vector<double> over_noise_by_fold(const std::vector<Prediction>& predicted, Of channels) const;
  template <class Work>
  void for_each_miss(const std::vector<Prediction>& predicted, const Work& work) const {
    for (std::size_t f = 0; f < folds_.size(); ++f) for_each_miss_of(f, predicted[f], work);
  }

 private:
  template <class Work>
  void for_each_miss_of(std::size_t fold, const Prediction& predicted, const Work& work) const {
    for (std::size_t r = 0; r < folds_[fold].kept_out.size(); ++r) {
      for (const MeasuredChannel& c : folds_[fold].kept_out[r].channels) {
        for (Eigen::Index i = 0; i < c.value.size(); ++i) {
          if (!std::isnan(c.value[i])) work(c, c.value[i] - predicted[r](c.output, i));
        }
      }
    }
  }
  /// Whether what a search without some rows found is a claim, of the same lasting_kind(), or its effect at a place that the claim's is not told from.
  [[nodiscard]] bool is_told_as(std::size_t claim, const Candidate& found) const;
  /// @param x  empty: no numbers fit, and the scenario stays as it is written
  [[nodiscard]] Prediction filed(const Hypothesis& hypothesis, const Eigen::VectorXd& x, std::size_t f) const;

  const Fitter& whole_;
  const SearchResult& result_;
  const std::map<std::string, NoiseModel>& noise_;
  std::vector<Fold> folds_;
  std::vector<std::unique_ptr<Fitter>> fitters_;
  std::map<Subset, Judged> judged_;
  Prediction written_;
};

/// Of readings in what they are shown in: K, um, urad.
[[nodiscard]] double shown_scale(const std::string& unit);

/// Predictions of all folds by several models; empty: there is none.
struct Models {
  std::vector<Prediction> written, calibrated, extended, named = {}, found = {};
};

[[nodiscard]] KeptOutMisses misses_of(const Judge& judge, const Models& models);
[[nodiscard]] std::vector<ChannelGain> channel_gains(const std::vector<MeasuredRun>& runs,
                                                     const std::map<std::string, NoiseModel>& noise, const Judge& judge,
                                                     const Models& models);

}  // namespace driftwright::diagnosis
