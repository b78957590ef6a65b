#pragma once
// Evaluates claims on kept-out rows: how likely the rows are with them, and how large the errors.

#include <map>
#include <memory>

#include "diagnosis/gain.hpp"
#include "diagnosis/kept_out_rows.hpp"
#include "diagnosis/plain_regression.hpp"

namespace driftwright::diagnosis {

/// A set of claims that are fitted together, one bit each.
using Subset = unsigned;

/// Evaluates sets of claims on folds; each set is fitted once.
class Judge {
 public:
  /// All arguments must outlive the judge.
  Judge(const Fitter& fitter, const SearchResult& result, const std::map<std::string, NoiseModel>& noise,
        std::vector<Fold> folds);

  /// The result of some claims on the folds, with all numbers fitted anew to the fitted rows of each.
  struct Judged {
    std::vector<Prediction> predicted;  ///< of all runs, one per fold
    /// Logarithm of the probability of the kept-out rows given the fitted ones, summed over the folds, up to a constant
    /// of all sets: the evidence of all rows minus that of the fitted ones.
    double log_predictive = 0.0;
    std::vector<double> log_evidence = {};  ///< of the fitted rows of each fold
    Hypothesis hypothesis = {};
    std::vector<Eigen::VectorXd> x = {};  ///< of each fold's fit; empty if there is none
  };
  const Judged& judged(Subset claims);
  /// Predictions of kept-out rows by a file with some claims, with numbers fitted to a fold's rows. In a run that is kept
  /// out completely, the times of events are unknown, as in a future run: no window of time is open in it.
  [[nodiscard]] std::vector<Prediction> filed(Subset claims);
  /// The same for future records: without claims or numbers of single records, such as the offset of one record's
  /// ambient.
  [[nodiscard]] std::vector<Prediction> filed_elsewhere(Subset claims);
  /// The least evidence of a claim in the fitted rows of a fold [nats], without its cost: what would be known without
  /// some rows.
  [[nodiscard]] double least_evidence(Subset claims, Subset without);
  /// Predictions of regressions without a machine model.
  [[nodiscard]] std::vector<Prediction> regressed(Regressors regressors) const;
  [[nodiscard]] std::vector<Prediction> written() const { return std::vector<Prediction>(folds_.size(), written_); }

  /// Whether some claims predict kept-out rows with larger errors than fewer of them, unless the likelihood clearly says
  /// otherwise.
  [[nodiscard]] bool is_worse(Subset claims, Subset fewer);
  /// The same with a quarter more in the squares, which speaks against the claims and not only against writing them: if
  /// numbers beyond their prior can do the same as a claim, both have about the same errors.
  [[nodiscard]] bool is_much_worse(Subset claims, Subset fewer);

  /// Root mean square of kept-out errors divided by the noise of their channels. NaN if no kept-out row can judge.
  [[nodiscard]] double over_noise(const std::vector<Prediction>& predicted) const;
  /// Squares of kept-out errors divided by those of noise, not whitened: what a user sees of them.
  [[nodiscard]] double squares_over_noise(const std::vector<Prediction>& predicted) const;
  /// over_noise() of each fold. @param channel  only this one; "": all
  [[nodiscard]] std::vector<double> over_noise_by_fold(const std::vector<Prediction>& predicted,
                                                       const std::string& channel) const;
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
  /// @param x  empty: no fit, and the scenario stays as written
  [[nodiscard]] Prediction filed(const Hypothesis& hypothesis, const Eigen::VectorXd& x, std::size_t f) const;

  const Fitter& whole_;
  const SearchResult& result_;
  const std::map<std::string, NoiseModel>& noise_;
  std::vector<Fold> folds_;
  std::vector<std::unique_ptr<Fitter>> fitters_;
  std::map<Subset, Judged> judged_;
  Prediction written_;
};

/// Predictions of all folds by several models; empty: not available.
struct Models {
  std::vector<Prediction> written, calibrated, extended, named = {};
};

[[nodiscard]] KeptOutMisses misses_of(const Judge& judge, const Models& models);
[[nodiscard]] std::vector<ChannelGain> channel_gains(const std::vector<MeasuredRun>& runs,
                                                     const std::map<std::string, NoiseModel>& noise, const Judge& judge,
                                                     const Models& models);

}  // namespace driftwright::diagnosis
