#include "scenarios/reader/film_files.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>

#include "base/config_map.hpp"
#include "base/delimited_text.hpp"
#include "base/file_bytes.hpp"
#include "base/quantity.hpp"
#include "mesh/read_surface_values.hpp"

namespace driftwright::scenarios {
namespace {

namespace fs = std::filesystem;
using effects::Effect;
using effects::FieldOver;
using effects::SurfaceField;

constexpr double kColdestAir_K = 150.0, kHottestAir_K = 1000.0;  // as the parameter `air`; beyond it is another unit
constexpr double kMostFilm_W_m2K = 1e6;                          // as the parameter `film` of convection

/// A file of a pattern, and the operating point or time that its name gives.
struct FilmFile {
  std::string path;
  double at = 0.0;  ///< [rpm] or [s]
};

/// What follows from a name: <rpm>, <s>, <min>.
struct Placeholder {
  const char* text;
  FieldOver over;
  double factor;
};
constexpr Placeholder kPlaceholders[] = {
    {"<rpm>", FieldOver::kSpeed, 1.0}, {"<s>", FieldOver::kTime, 1.0}, {"<min>", FieldOver::kTime, 60.0}};

[[noreturn]] void fail_at_file(const Effect& e, const std::string& message) {
  throw InputError(e.reference_where.at("file"), message);
}

/// All files of a pattern, by rising operating point or time. `over`: what replaces the placeholder in their names, speed
/// or time.
std::vector<FilmFile> files_of(const Effect& e, FieldOver& over) {
  const fs::path path = e.words.at("file");
  const Placeholder* holder = nullptr;
  fs::path before, after;
  std::string piece;
  for (const fs::path& part : path) {
    for (const Placeholder& p : kPlaceholders) {
      if (holder || part.string().find(p.text) == std::string::npos) continue;
      holder = &p;
      piece = part.string();
    }
    if (!holder) {
      before /= part;
    } else if (part.string() != piece) {
      after /= part;
    }
  }
  if (!holder) {
    if (!fs::is_regular_file(path)) fail_at_file(e, fmt::format("there is no file '{}'", clean_name(path.string())));
    return {{path.string(), 0.0}};
  }
  over = holder->over;
  const std::size_t at = piece.find(holder->text);
  const std::string head = piece.substr(0, at), tail = piece.substr(at + std::string(holder->text).size());
  std::vector<FilmFile> files;
  std::error_code failed;
  for (const auto& entry : fs::directory_iterator(before.empty() ? "." : before, failed)) {
    const std::string name = entry.path().filename().string();
    if (name.size() <= head.size() + tail.size() || !name.starts_with(head) || !name.ends_with(tail)) continue;
    const char *first = name.data() + head.size(), *last = name.data() + name.size() - tail.size();
    double value = 0.0;
    const auto [end, error] = std::from_chars(first, last, value);
    const fs::path file = after.empty() ? entry.path() : entry.path() / after;
    if (error != std::errc() || end != last || !(value >= 0.0) || !fs::is_regular_file(file)) continue;
    files.push_back({file.string(), holder->factor * value});
  }
  std::sort(files.begin(), files.end(), [](const FilmFile& a, const FilmFile& b) { return a.at < b.at; });
  if (files.empty())
    fail_at_file(
        e, fmt::format("no file matches '{}'; {} must be a number in the name", clean_name(path.string()), holder->text));
  for (std::size_t i = 1; i < files.size(); ++i) {
    if (files[i].at == files[i - 1].at)
      fail_at_file(e, fmt::format("'{}' and '{}' give the same {}", clean_name(files[i - 1].path), clean_name(files[i].path),
                                  holder->text));
  }
  return files;
}

/// The columns of a text file, and where each row is.
struct FilmTable {
  std::string path;
  std::vector<std::string> names, lines;
  std::vector<int> line_of_row;
  std::vector<std::vector<double>> rows;
  int header_line = 0;

  [[nodiscard]] std::optional<std::size_t> find(const std::string& name) const {
    const auto at = std::find(names.begin(), names.end(), name);
    if (at == names.end()) return std::nullopt;
    return static_cast<std::size_t>(at - names.begin());
  }
  [[nodiscard]] Where where(int line, const std::string& key) const {
    return {.file = path, .line = line, .column = 1, .key = key, .excerpt = lines[static_cast<std::size_t>(line) - 1]};
  }
  [[noreturn]] void lacks(const std::string& name, const std::string& advice) const {
    throw InputError(where(header_line, name),
                     fmt::format("there is no column {}; the columns are {}. {}", name, fmt::join(names, ", "), advice));
  }
};

/// A CSV with a header, or OpenFOAM's raw format: lines "x y z value" after comments, the last of which names the columns.
FilmTable read_film_table(const std::string& path, bool is_raw) {
  FilmTable table;
  table.path = clean_name(path);
  table.lines = read_text_lines(path);
  char separator = is_raw ? ' ' : ',';
  if (is_raw) table.names = {"x", "y", "z", "value"};
  for (std::size_t i = 0; i < table.lines.size(); ++i) {
    const std::string& line = table.lines[i];
    const int number = static_cast<int>(i) + 1;
    if (line.find_first_not_of(" \t") == std::string::npos) continue;
    try {
      if (line.front() == '#') {
        if (!is_raw || !table.rows.empty()) continue;
        std::vector<std::string> words;
        for (const Cell& cell : split_cells(line.substr(1), ' ')) {
          if (!cell.text.empty()) words.push_back(cell.text);
        }
        if (words.size() >= 4 && words[0] == "x" && words[1] == "y" && words[2] == "z") {
          table.names = words;
          table.header_line = number;
        }
        continue;
      }
      if (table.header_line == 0) {
        table.header_line = number;
        if (!is_raw) {
          if (line.find(';') != std::string::npos) separator = ';';
          for (const Cell& cell : split_cells(line, separator)) table.names.push_back(cell.text);
          continue;
        }
      }
      std::vector<Cell> cells = split_cells(line, separator);
      if (is_raw) std::erase_if(cells, [](const Cell& c) { return c.text.empty(); });
      if (cells.size() != table.names.size())
        throw RangeError(fmt::format("the row has {} cells, and there are {} columns: {}", cells.size(), table.names.size(),
                                     fmt::join(table.names, ", ")));
      std::vector<double> row;
      for (std::size_t c = 0; c < cells.size(); ++c) {
        const bool has_comma = separator == ';' && cells[c].text.find(',') != std::string::npos;
        try {
          row.push_back(parse_number(cells[c].text, has_comma ? ',' : '.'));
        } catch (const RangeError& error) {
          throw InputError(
              Where{.file = table.path, .line = number, .column = cells[c].column, .key = table.names[c], .excerpt = line},
              error.what());
        }
      }
      table.rows.push_back(std::move(row));
      table.line_of_row.push_back(number);
    } catch (const RangeError& error) {
      throw InputError(table.where(number, ""), error.what());
    }
  }
  if (table.rows.empty()) throw InputError(fmt::format("{}: the file has no rows of numbers", table.path));
  return table;
}

/// Column of a text file and the factor to SI.
struct FilmColumn {
  std::size_t index;
  double factor;
};

FilmColumn coordinate(const FilmTable& table, const char* axis, bool is_raw, double unit_m) {
  if (is_raw) return {*table.find(axis), unit_m};
  for (const auto& [suffix, factor] : {std::pair{"_mm", 1e-3}, {"_m", 1.0}}) {
    if (const auto found = table.find(std::string(axis) + suffix)) return {*found, factor};
  }
  table.lacks(std::string(axis) + "_mm", "Coordinates of the points are required: x_mm, y_mm, z_mm, or x_m, y_m, z_m");
}

bool is_celsius(const std::string& name) {
  return name.ends_with("_degC");
}

/// The film's column and its sign: `film_column: -NAME` takes the negative of a column NAME.
struct FilmName {
  std::string name;
  double sign = 1.0;
};
template <class Has>
FilmName film_name_of(const std::string& written, const Has& has) {
  if (!written.starts_with("-") || has(written)) return {written};
  return {written.substr(1), -1.0};
}

double film_checked(double value, const FilmName& film, const std::function<Where()>& where) {
  const double film_W_m2K = film.sign * value;
  if (film_W_m2K >= 0.0 && film_W_m2K <= kMostFilm_W_m2K) return film_W_m2K;
  const bool is_other_sign = -film_W_m2K <= kMostFilm_W_m2K && film.sign > 0.0;
  throw InputError(
      where(), fmt::format("a film coefficient of {:g} W/(m^2 K) is not possible; 0 to {:g} are allowed{}", film_W_m2K,
                           kMostFilm_W_m2K,
                           is_other_sign ? fmt::format(". If all are negative, as OpenFOAM's `heatTransferCoeff` is at a "
                                                       "wall warmer than its TRef, write `film_column: -{}`",
                                                       film.name)
                                         : ""));
}
double air_checked_K(double value, const std::string& name, const std::function<Where()>& where) {
  const double air_K = is_celsius(name) ? value + kZeroCelsius_K : value;
  if (air_K >= kColdestAir_K && air_K <= kHottestAir_K) return air_K;
  throw InputError(where(),
                   fmt::format("an air temperature of {:g} {} is not possible; {:g} to {:g} K are allowed. A column in degC "
                               "must have a name that ends with _degC",
                               value, is_celsius(name) ? "degC" : "K", kColdestAir_K, kHottestAir_K));
}

/// Rows of one state: each point once.
struct FilmState {
  std::map<std::array<double, 3>, std::pair<double, double>> film_and_air;  ///< by position [m]
  bool has_air = false;
};

/// Adds the rows of a text file to the states that they belong to.
void add_rows(const Effect& e, const FilmTable& table, bool is_raw, double file_at, FieldOver& over,
              std::map<double, FilmState>& states) {
  const double unit_m = e.words.at("units") == "mm" ? 1e-3 : 1.0;
  const FilmColumn axes[] = {coordinate(table, "x", is_raw, unit_m), coordinate(table, "y", is_raw, unit_m),
                             coordinate(table, "z", is_raw, unit_m)};
  std::string film_name = e.words.at("film_column"), air_name = e.words.at("air_column");
  if (film_name.empty()) film_name = is_raw ? table.names[3] : "h_W_m2K";
  const FilmName film_of = film_name_of(film_name, [&](const std::string& n) { return table.find(n).has_value(); });
  const auto film = table.find(film_of.name);
  if (!film) table.lacks(film_of.name, "`film_column` names the column of the film coefficient in W/(m^2 K)");
  if (air_name.empty() && !is_raw) {
    for (const char* name : {"T_air_degC", "T_air_K"}) {
      if (air_name.empty() && table.find(name)) air_name = name;
    }
  }
  const auto air = table.find(air_name);
  if (!air_name.empty() && !air) table.lacks(air_name, "`air_column` names the column of the air temperature");
  std::optional<FilmColumn> at;
  for (const auto& [name, what, factor] : {std::tuple{"speed_rpm", FieldOver::kSpeed, 1.0},
                                           {"time_s", FieldOver::kTime, 1.0},
                                           {"time_min", FieldOver::kTime, 60.0},
                                           {"time_h", FieldOver::kTime, 3600.0}}) {
    const auto found = table.find(name);
    if (!found) continue;
    if (at || over != FieldOver::kNothing)
      throw InputError(table.where(table.header_line, name),
                       "a film follows the speed or the time, by one column or by the name of the file");
    at = FilmColumn{*found, factor};
    over = what;
  }
  for (std::size_t r = 0; r < table.rows.size(); ++r) {
    const std::vector<double>& row = table.rows[r];
    const auto where = [&](const std::string& key) { return [&, key] { return table.where(table.line_of_row[r], key); }; };
    std::array<double, 3> x_m;
    for (std::size_t a = 0; a < 3; ++a) x_m[a] = axes[a].factor * row[axes[a].index];
    const double value = film_checked(row[*film], film_of, where(film_of.name));
    const double air_K = air ? air_checked_K(row[*air], air_name, where(air_name)) : 0.0;
    const double point = at ? at->factor * row[at->index] : file_at;
    if (!(point >= 0.0)) throw InputError(where("")(), "the speed or time must not be negative");
    FilmState& state = states[point];
    state.has_air = air.has_value();
    if (!state.film_and_air.emplace(x_m, std::pair{value, air_K}).second)
      throw InputError(where("")(), "the point is given twice for the same speed or time");
  }
}

SurfaceField read_points(const Effect& e, const std::vector<FilmFile>& files, bool is_raw, FieldOver over) {
  std::map<double, FilmState> states;
  const FieldOver of_name = over;
  for (const FilmFile& file : files) {
    FieldOver of_file = of_name;
    add_rows(e, read_film_table(file.path, is_raw), is_raw, file.at, of_file, states);
    over = of_file;
  }
  SurfaceField field;
  field.states.over = states.size() > 1 ? over : FieldOver::kNothing;
  field.states.at.clear();
  const auto& first = states.begin()->second;
  const auto n = static_cast<Eigen::Index>(first.film_and_air.size()), n_states = static_cast<Eigen::Index>(states.size());
  field.point_m.resize(3, n);
  field.film_W_m2K.resize(n, n_states);
  if (first.has_air) field.air_K.resize(n, n_states);
  Eigen::Index s = 0;
  for (const auto& [at, state] : states) {
    field.states.at.push_back(states.size() > 1 ? at : 0.0);
    const bool is_same =
        state.has_air == first.has_air &&
        std::equal(state.film_and_air.begin(), state.film_and_air.end(), first.film_and_air.begin(),
                   first.film_and_air.end(), [](const auto& a, const auto& b) { return a.first == b.first; });
    if (!is_same)
      fail_at_file(
          e, fmt::format("the {} points at {:g} {} are not those at {:g} ({}); give all speeds or times on the same "
                         "points, with the same columns",
                         state.film_and_air.size(), at, over == FieldOver::kSpeed ? "rpm" : "s", states.begin()->first, n));
    Eigen::Index v = 0;
    for (const auto& [x_m, values] : state.film_and_air) {
      field.point_m.col(v) = Eigen::Vector3d(x_m[0], x_m[1], x_m[2]);
      field.film_W_m2K(v, s) = values.first;
      if (first.has_air) field.air_K(v, s) = values.second;
      ++v;
    }
    ++s;
  }
  if (n < 2 && !e.has("reach"))
    fail_at_file(e, "the file has one point alone, which has no spacing; say how far it counts with `reach`");
  return field;
}

/// The array of a VTK file that holds a value. @param usual  names that are tried if none is given
const std::vector<double>* array_of(const mesh::SurfaceValues& values, const std::string& name,
                                    const std::vector<std::string>& usual, const std::string& path, const char* key,
                                    std::string& found) {
  std::vector<std::string> names;
  for (const auto& [n, array] : values.arrays) names.push_back(n);
  for (const std::string& n : name.empty() ? usual : std::vector{name}) {
    if (const auto at = values.arrays.find(n); at != values.arrays.end()) {
      found = n;
      return &at->second;
    }
  }
  if (name.empty() && std::string(key) == "air_column") return nullptr;
  throw InputError(fmt::format("{}: there is no array {}; it has {}. `{}` names the array", clean_name(path),
                               name.empty() ? usual.front() : name, fmt::join(names, ", "), key));
}

SurfaceField read_cells(const Effect& e, const std::vector<FilmFile>& files, FieldOver over) {
  SurfaceField field;
  field.states.over = files.size() > 1 ? over : FieldOver::kNothing;
  field.states.at.clear();
  const double unit_m = e.words.at("units") == "mm" ? 1e-3 : 1.0;
  for (std::size_t s = 0; s < files.size(); ++s) {
    const mesh::SurfaceValues values = mesh::read_surface_values(files[s].path);
    const auto n = static_cast<Eigen::Index>(values.corner_from.size()) - 1;
    const auto column = static_cast<Eigen::Index>(s), n_states = static_cast<Eigen::Index>(files.size());
    FilmName film_of =
        film_name_of(e.words.at("film_column"), [&](const std::string& name) { return values.arrays.contains(name); });
    std::string air_name;
    const std::vector<double>* film =
        array_of(values, film_of.name, {"h_W_m2K"}, files[s].path, "film_column", film_of.name);
    const std::vector<double>* air =
        array_of(values, e.words.at("air_column"), {"T_air_degC", "T_air_K"}, files[s].path, "air_column", air_name);
    const Eigen::Matrix3Xd corner_m = unit_m * values.corner;
    if (s == 0) {
      field.corner_from = values.corner_from;
      field.corner_m = corner_m;
      field.film_W_m2K.resize(n, n_states);
      if (air) field.air_K.resize(n, n_states);
      field.point_m.resize(3, n);
      for (Eigen::Index c = 0; c < n; ++c) {
        const Eigen::Index from = values.corner_from[static_cast<std::size_t>(c)],
                           to = values.corner_from[static_cast<std::size_t>(c) + 1];
        field.point_m.col(c) = corner_m.middleCols(from, to - from).rowwise().mean();
      }
    } else {
      const double size_m = (field.corner_m.rowwise().maxCoeff() - field.corner_m.rowwise().minCoeff()).norm();
      const bool is_same = values.corner_from == field.corner_from &&
                           (corner_m - field.corner_m).cwiseAbs().maxCoeff() <= 1e-5 * size_m;  // files in single precision
      if (!is_same || (air != nullptr) != (field.air_K.size() > 0))
        fail_at_file(e,
                     fmt::format("the faces or arrays of '{}' are not those of '{}'; give all speeds or times on the same "
                                 "faces, with the same arrays",
                                 clean_name(files[s].path), clean_name(files[0].path)));
    }
    for (Eigen::Index c = 0; c < n; ++c) {
      const auto where = [&](const std::string& name) {
        return [&, name] { return Where{clean_name(files[s].path), 0, 0, fmt::format("face {}, {}", c, name), ""}; };
      };
      field.film_W_m2K(c, column) = film_checked((*film)[static_cast<std::size_t>(c)], film_of, where(film_of.name));
      if (air) field.air_K(c, column) = air_checked_K((*air)[static_cast<std::size_t>(c)], air_name, where(air_name));
    }
    field.states.at.push_back(files.size() > 1 ? files[s].at : 0.0);
  }
  return field;
}

/// Of the values as they were read, so that other `units` or another column give another one.
std::string hash_of(const SurfaceField& field) {
  std::string bytes;
  const auto add = [&](const auto& values) {
    bytes.append(reinterpret_cast<const char*>(values.data()),
                 static_cast<std::size_t>(values.size()) * sizeof(*values.data()));
  };
  add(field.point_m);
  add(field.corner_from);
  add(field.corner_m);
  add(field.film_W_m2K);
  add(field.air_K);
  return content_hash(bytes);
}

}  // namespace

void read_film_files(std::vector<Effect>& effects, const std::string& folder) {
  for (Effect& e : effects) {
    const bool has_file = std::any_of(e.kind->mentions.begin(), e.kind->mentions.end(),
                                      [](const effects::Mention& m) { return m.of == effects::Mention::Of::kFile; });
    if (!has_file) continue;
    // Absolute, so that a scenario in another folder has the same effect.
    std::string& name = e.words.at("file");
    name = fs::absolute(fs::path(folder) / name).lexically_normal().string();
    FieldOver over = FieldOver::kNothing;
    const std::vector<FilmFile> files = files_of(e, over);
    const std::string extension = fs::path(files.front().path).extension().string();
    SurfaceField field;
    if (extension == ".csv") {
      field = read_points(e, files, false, over);
    } else if (extension == ".raw" || extension == ".xy") {
      field = read_points(e, files, true, over);
    } else if (extension == ".vtp" || extension == ".vtu" || extension == ".vtk") {
      field = read_cells(e, files, over);
    } else {
      fail_at_file(e, fmt::format("'{}' is no format of films; .csv, .raw, .xy, .vtp, .vtu and .vtk are", extension));
    }
    if (field.air_K.size() > 0 && e.has("air"))
      throw InputError(e.where, "the file has air temperatures; leave `air` out, or remove them from the file");
    field.hash = hash_of(field);
    effects::set_means(field);
    e.field = std::make_shared<const SurfaceField>(std::move(field));
  }
}

}  // namespace driftwright::scenarios
