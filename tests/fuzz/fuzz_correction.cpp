// Tables of corrections for `inject`.

#include "compensation/injector/correction_input.hpp"
#include "tests/fuzz/driver.hpp"

using namespace driftwright;

int main(int argc, char** argv) {
  return fuzz::run(argc, argv,
                   {.name = "correction",
                    .corpus = {"tests/fuzz/corpus/corrections"},
                    .extensions = {".csv"},
                    .words = {"row", "time_s", "time_min", "_um", "_count", ",", "#", "\xEF\xBB\xBF", "\xFF\xFE"},
                    .read = [](const std::filesystem::path& file) {
                      compensation::CorrectionInput input(file.string(), {.period_um = 4.0, .row_s = 1e-3});
                      for (std::int64_t row = 1; row < 1000; ++row) (void)input.quarters_at(row);
                    }});
}
