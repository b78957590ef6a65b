#include "base/npy_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "base/errors.hpp"
#include "tests/shared/numpy.hpp"

namespace driftwright::npy_file_test {
namespace {

using ::testing::HasSubstr;

/// What a reader says of a file that it does not take.
template <class Scalar>
std::string refusal(const std::filesystem::path& file) {
  try {
    (void)read_npy<Scalar>(file);
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

template <class Matrix>
std::filesystem::path written(const std::string& name, const Matrix& values) {
  const auto file = temporary_folder() / name;
  write_npy(file, values);
  return file;
}

TEST(NpyFile, GivesBackEveryBitOfEachType) {
  Eigen::MatrixXd d(3, 2);
  d << 0.1, -0.0, 1e-310, std::numeric_limits<double>::infinity(), 1.0 / 3.0, -1e308;
  const Eigen::MatrixXd read = read_npy<double>(written("d.npy", d));
  EXPECT_EQ(read, d);
  EXPECT_TRUE(std::signbit(read(0, 1)));
  Eigen::MatrixXf f(2, 3);
  f << 0.1F, 2.0F, -3.5e-40F, 4.0F, 5.0F, 6.0F;
  EXPECT_EQ(read_npy<float>(written("f.npy", f)), f);
  Eigen::MatrixXi i(2, 2);
  i << 1, -2, std::numeric_limits<int>::max(), std::numeric_limits<int>::min();
  EXPECT_EQ(read_npy<int>(written("i.npy", i)), i);
}

TEST(NpyFile, KeepsShapesOfColumnsRowsAndOfNothing) {
  const Eigen::MatrixXd all = Eigen::MatrixXd::Random(7, 9);
  for (const auto& [rows, columns] :
       std::vector<std::pair<int, int>>{{7, 9}, {7, 1}, {1, 9}, {1, 1}, {0, 1}, {0, 0}, {0, 4}, {5, 0}}) {
    const Eigen::MatrixXd values = all.topLeftCorner(rows, columns);
    const Eigen::MatrixXd read = read_npy<double>(written("shape.npy", values));
    EXPECT_EQ(read.rows(), rows);
    EXPECT_EQ(read.cols(), columns);
    EXPECT_EQ(read, values);
  }
}

TEST(NpyFile, WritesAPartOfAMatrix) {
  const Eigen::MatrixXd all = Eigen::MatrixXd::Random(7, 9);
  EXPECT_EQ(read_npy<double>(written("part.npy", all.block(2, 3, 4, 5))), all.block(2, 3, 4, 5));
}

TEST(NpyFile, ValuesBeginOnAMultipleOf64Bytes) {
  // NEP 1 requires it; sizes about powers of ten change the header's length.
  for (int n : {1, 9, 10, 99, 100, 1000, 100000}) {
    const auto file = written("aligned.npy", Eigen::VectorXd(Eigen::VectorXd::Zero(n)));
    EXPECT_EQ((std::filesystem::file_size(file) - 8u * static_cast<unsigned>(n)) % 64, 0u) << n;
  }
}

TEST(NpyFile, RefusesWhatItHasNotWritten) {
  EXPECT_THAT(refusal<double>(temporary_folder() / "missing.npy"), HasSubstr("missing.npy"));
  const auto file = written("one.npy", Eigen::MatrixXd(Eigen::MatrixXd::Random(4, 3)));
  EXPECT_THAT(refusal<float>(file), HasSubstr("another type"));
  EXPECT_THAT(refusal<int>(file), HasSubstr("another type"));
  std::string text = read_text(file);
  const auto with = [&](const std::string& what, const std::string& instead) {
    std::string changed = text;
    changed.replace(changed.find(what), what.size(), instead);
    return write_file("changed.npy", changed);
  };
  EXPECT_THAT(refusal<double>(with("'fortran_order': True", "'fortran_order': False")), HasSubstr("order"));
  EXPECT_THAT(refusal<double>(with("<f8", ">f8")), HasSubstr("another type"));
  EXPECT_THAT(refusal<double>(with("NUMPY", "NUMPI")), HasSubstr("NumPy"));
  EXPECT_THAT(refusal<double>(with("(4, 3)", "(-4, 3)")), HasSubstr("shape"));
  EXPECT_THAT(refusal<double>(with("(4, 3)", "(x, 3)")), HasSubstr("shape"));
  EXPECT_THAT(refusal<double>(with("(4, 3)", "(9000000000000000000, 9000000000000000000)")), HasSubstr("cut short"));
  EXPECT_THAT(refusal<double>(with("(4, 3)", "(4, 4)")), HasSubstr("cut short"));
  EXPECT_THAT(refusal<double>(temporary_folder()), HasSubstr("NumPy")) << "a folder";
}

TEST(NpyFile, RefusesAFileCutShortAnywhere) {
  const std::string whole = read_text(written("whole.npy", Eigen::MatrixXd(Eigen::MatrixXd::Random(4, 3))));
  for (std::size_t kept = 0; kept < whole.size(); ++kept) {
    EXPECT_NE(refusal<double>(write_file("cut.npy", whole.substr(0, kept))), "") << kept << " bytes";
  }
}

TEST(NpyFile, SaysWhereItCannotWrite) {
  EXPECT_THROW(write_npy(temporary_folder() / "nowhere" / "a.npy", Eigen::MatrixXd(2, 2)), InputError);
}

TEST(NpyFile, IsWhatNumPyReadsAndWrites) {
  if (!has_numpy()) GTEST_SKIP() << "no python3 with numpy";
  Eigen::MatrixXd d(3, 2);
  d << 1, 2, 3, 4, 5, 6.5;
  (void)written("n_d.npy", d);
  (void)written("n_f.npy", Eigen::MatrixXf(d.cast<float>()));
  (void)written("n_i.npy", Eigen::MatrixXi(d.cast<int>()));
  (void)written("n_column.npy", Eigen::MatrixXd(d.col(1)));
  (void)written("n_empty.npy", Eigen::MatrixXd(0, 4));
  EXPECT_EQ(run_numpy(R"(
a = np.array([[1, 2], [3, 4], [5, 6.5]])
for name, want in [('d', a), ('f', a.astype(np.float32)), ('i', a.astype(np.int32)), ('column', a[:, 1]), ('empty', np.zeros((0, 4)))]:
    got = np.load('n_' + name + '.npy', allow_pickle=False)
    assert got.dtype == want.dtype and got.shape == want.shape and (got == want).all(), name
    assert got.flags.f_contiguous, name
    np.save('p_' + name + '.npy', np.asfortranarray(want))
    if want.size and want.ndim == 2:
        assert open('p_' + name + '.npy', 'rb').read() == open('n_' + name + '.npy', 'rb').read(), name + ' differs in bytes'
)"),
            "");
  EXPECT_EQ(read_npy<double>(temporary_folder() / "p_d.npy"), d);
}

}  // namespace
}  // namespace driftwright::npy_file_test
