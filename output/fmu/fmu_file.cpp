#include "output/fmu/fmu_file.hpp"

#include <fmt/format.h>
#include <minizip/zip.h>

#include <algorithm>
#include <cctype>
#include <stdexcept>

#include "base/file_bytes.hpp"
#include "output/fmu/model_data.hpp"
#include "output/fmu/source_files.hpp"

namespace driftwright::output {
namespace {

namespace fs = std::filesystem;

bool is_wanted(const std::string& name, const FmuOrder& order) {
  const bool is_2 = order.version == FmiVersion::k2;
  if (name.starts_with("fmi2")) return is_2;
  if (name.starts_with("fmi3")) return !is_2;
  if (name == "plain_model.c" || name == "example.c") return false;  // of plain_c.hpp
  return is_of_model(name, order.model.observer.has_value());
}

/// Compiled with Driftwright, with the numbers of this model at its end.
std::string binary(const FmuOrder& order, const std::string& guid) {
  const std::string name =
      fmt::format("fmi{}_{}.so", order.version == FmiVersion::k2 ? 2 : 3, order.model.observer ? "observer" : "machine");
  const std::vector<SourceFile>& all = fmu_binaries();
  const auto found = std::find_if(all.begin(), all.end(), [&](const SourceFile& b) { return b.name == name; });
  if (found == all.end()) throw std::logic_error(name + " is not among the binaries");
  return found->text + model_numbers(order.model, guid);
}

std::string page(const FmuOrder& order, const Provenance& made_by, const std::string& guid) {
  const std::string reference = order.reference_out.empty() ? ""
                                                            : fmt::format(
                                                                  "<p>resources/reference_in.csv and reference_out.csv hold "
                                                                  "{}: with these inputs, held from row to row, the unit "
                                                                  "gives these outputs.</p>\n",
                                                                  order.reference_words);
  return fmt::format(
      "<!DOCTYPE html>\n<html><head><meta "
      "charset=\"utf-8\"><title>{0}</title></head><body>\n<h1>{0}</h1>\n<p>{1}.</p>\n<p>Made by "
      "Driftwright {2} of the scenario {3}; {4}.</p>\n{5}<p>docs/how-to/fmu.md of Driftwright says what the variables mean "
      "and how "
      "exact the unit "
      "is.</p>\n</body></html>\n",
      order.model.name, order.model.description, made_by.version, made_by.scenario, guid, reference);
}

}  // namespace

bool is_of_model(const std::string& name, bool is_observer) {
  if (name == "machine.c" || name.starts_with("formula.") || name.starts_with("live.") || name.starts_with("switches."))
    return !is_observer;
  if (name == "observer.c" || name == "observer_filter.c" || name == "probe_feedback.c" ||
      name.starts_with("state_observer"))
    return is_observer;
  return true;
}

std::string model_identifier(const std::string& name) {
  std::string id = name.empty() || std::isdigit(static_cast<unsigned char>(name[0])) ? "m_" : "";
  for (char ch : name) id += std::isalnum(static_cast<unsigned char>(ch)) ? ch : '_';
  return id;
}

std::vector<FmuEntry> fmu_entries(const FmuOrder& order, const Provenance& made_by) {
  const bool is_2 = order.version == FmiVersion::k2;
  const std::string identifier = model_identifier(order.model.name), tool = "Driftwright " + made_by.version,
                    words = fmt::format("Driftwright {}, scenario {}.", made_by.version, made_by.scenario);
  const std::vector<FmuVariable> variables = variables_of(order.model);
  std::vector<SourceFile> sources;
  std::vector<std::string> c_files;
  for (const SourceFile& s : fmu_source_files()) {
    if (is_wanted(s.name, order)) sources.push_back(s);
  }
  sources.push_back({"model_data.c", ""});
  for (const SourceFile& s : sources) {
    if (s.name.ends_with(".c")) c_files.push_back(s.name);
  }
  std::sort(c_files.begin(), c_files.end());
  const auto description = [&](const std::string& guid) {
    return model_description(order.model, variables, order.version, order.interfaces, identifier, guid, tool, c_files,
                             order.step_s);
  };
  // A fingerprint of description and numbers, in the form of a GUID.
  const std::string of_numbers = model_data_c(order.model, "", words), of_names = description("");
  std::string code;
  for (const SourceFile& s : sources) code += s.text;
  const std::string hex = content_hash(of_names + code + of_numbers);
  const std::string guid = fmt::format("{{{}-{}-{}-{}-{}}}", hex.substr(0, 8), hex.substr(8, 4), hex.substr(12, 4),
                                       hex.substr(16, 4), hex.substr(20));
  sources.back().text = model_data_c(order.model, guid, words);

  std::vector<FmuEntry> entries = {{"modelDescription.xml", description(guid)}};
  for (const SourceFile& s : sources) entries.push_back({"sources/" + s.name, s.text});
  if (!is_2) entries.push_back({"sources/buildDescription.xml", build_description(identifier, c_files)});
  entries.push_back({fmt::format("binaries/{}/{}.so", is_2 ? "linux64" : "x86_64-linux", identifier), binary(order, guid)});
  entries.push_back({"documentation/index.html", page(order, made_by, guid)});
  if (!order.reference_out.empty()) {
    entries.push_back({"resources/reference_in.csv", order.reference_in});
    entries.push_back({"resources/reference_out.csv", order.reference_out});
  }
  return entries;
}

void write_zip(const fs::path& file, const std::vector<FmuEntry>& entries) {
  const auto fail = [&] { throw std::runtime_error(fmt::format("{}: the zip cannot be written", file.string())); };
  const zipFile zip = zipOpen64(file.c_str(), APPEND_STATUS_CREATE);
  if (!zip) fail();
  bool is_well = true;
  for (const FmuEntry& entry : entries) {
    zip_fileinfo info = {};
    info.tmz_date.tm_year = 1980;
    info.tmz_date.tm_mday = 1;
    is_well =
        is_well &&
        zipOpenNewFileInZip(zip, entry.path.c_str(), &info, nullptr, 0, nullptr, 0, nullptr, Z_DEFLATED, 6) == ZIP_OK &&
        zipWriteInFileInZip(zip, entry.bytes.data(), static_cast<unsigned>(entry.bytes.size())) == ZIP_OK &&
        zipCloseFileInZip(zip) == ZIP_OK;
  }
  if (zipClose(zip, nullptr) != ZIP_OK || !is_well) fail();
}

}  // namespace driftwright::output
