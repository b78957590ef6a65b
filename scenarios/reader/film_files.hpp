#pragma once
// Reads the files of effects `film_field`: film coefficients and air temperatures before a surface. Formats for the user:
// docs/how-to/films.md.

#include <string>
#include <vector>

#include "effects/effect.hpp"

namespace driftwright::scenarios {

/// Reads the file of each effect that names one, gives it to the effect (Effect::field) and makes its path absolute.
/// @param folder  of the scenario file; relative paths start there
/// @throws InputError  for a file that is missing or damaged, with line and column of a text file: a column that is
///                     missing, a cell that is no number, a negative film, an air temperature outside of 150 to 1000 K
///                     (another unit), states on different points, and for `air` beside air temperatures in the file
void read_film_files(std::vector<effects::Effect>& effects, const std::string& folder);

}  // namespace driftwright::scenarios
