// Files of predictors, with a corrected hash, so that the content after it is read, and the predictor run on a record.

#include <nlohmann/json.hpp>

#include "base/file_bytes.hpp"
#include "compensation/predictors/deployed_predictor.hpp"
#include "output/predictor_file.hpp"
#include "tests/fuzz/driver.hpp"

using namespace driftwright;

namespace {

void mend_hash(const std::filesystem::path& file) {
  using Json = nlohmann::ordered_json;
  Json j = Json::parse(read_bytes(file), nullptr, false);
  if (!j.is_object()) return;
  j.erase("hash");
  j["hash"] = content_hash(j.dump(-1, ' ', false, Json::error_handler_t::replace));
  write_bytes(file, j.dump(-1, ' ', false, Json::error_handler_t::replace));
}

}  // namespace

int main(int argc, char** argv) {
  return fuzz::run(argc, argv,
                   {.name = "predictor",
                    .corpus = {"tests/fuzz/corpus/predictors"},
                    .extensions = {".json"},
                    .words = {"{", "}", "[", "]", ",", "null", "true", "\"\"", "1e999", "-1", "\"formula\"", "\"observer\"",
                              "\"earlier_runs\"", "\"fail_safe\"", "\"terms\"", "\"guards\""},
                    .read = [](const std::filesystem::path& file) {
                      mend_hash(file);
                      (void)output::read_predictor(file.string());
                    }});
}
