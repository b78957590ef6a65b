#pragma once
// Lines and cells of text files from loggers and spreadsheets, converted to UTF-8 from any encoding.

#include <string>
#include <vector>

namespace driftwright {

/// A text file in UTF-8. A byte order mark identifies UTF-8 or UTF-16 and is removed. Without one, a file that is not valid
/// UTF-8 is read as Windows-1252, which has the same degree sign as Latin-1. The result can be written into any output of
/// the program.
/// @throws InputError  for a file that cannot be opened or contains bytes that are not text
[[nodiscard]] std::string read_text_file(const std::string& path);

/// A text that may contain file names in any encoding, as UTF-8: bytes that are not UTF-8 are read as Latin-1, the rest is
/// unchanged.
[[nodiscard]] std::string utf8_text(std::string text);

/// A name from outside (another file format, an argument) as text for all outputs: bytes that are not UTF-8 are
/// read as Latin-1, control characters become blanks.
[[nodiscard]] std::string clean_name(std::string name);

/// True if a text in UTF-8 contains a line break or another control character except tabs.
[[nodiscard]] bool has_control_character(const std::string& text);

/// The lines of a text file without their line breaks (LF, CR LF). @throws InputError  as read_text_file()
[[nodiscard]] std::vector<std::string> read_text_lines(const std::string& path);

/// A cell and where it begins.
struct Cell {
  std::string text;  ///< without surrounding quotation marks and blanks
  int column = 1;    ///< first byte in the line, from 1
};

/// The cells of a line. Separators inside quotation marks (") belong to the cell; a doubled quotation mark means one.
/// @param separator  ' ': any number of blanks and tabs
/// @throws RangeError  for an unclosed quotation mark
[[nodiscard]] std::vector<Cell> split_cells(const std::string& line, char separator);

/// A name in a normal form, so that two spellings compare equal: no blanks around it, hard blanks as blanks, both mu as the
/// micro sign.
[[nodiscard]] std::string plain_name(std::string text);

/// The number in a cell. The error message says what is wrong: decimal comma or point, thousands separators, text.
/// @throws RangeError  when the cell is not a finite number
[[nodiscard]] double parse_number(const std::string& text, char decimal);

}  // namespace driftwright
