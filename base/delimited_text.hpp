#pragma once
// Lines and cells of a text file as loggers and spreadsheets write them, in UTF-8 whatever the file is encoded in.

#include <string>
#include <vector>

namespace driftwright {

/// A text file in UTF-8. A byte order mark, which is left out, tells UTF-8 or UTF-16; without one a file that is no UTF-8 is taken as Windows-1252,
/// which has Latin-1's degree sign. What is read this way can be written into any output of ours.
/// @throws InputError  for a file that cannot be opened or holds bytes that are no text
[[nodiscard]] std::string read_text_file(const std::string& path);

/// A text that may hold names of files, in any encoding, as UTF-8: bytes that are none are taken as Latin-1, the rest stays as it is.
[[nodiscard]] std::string utf8_text(std::string text);

/// A name from elsewhere (another format of files, an argument) as text that all our outputs can carry: what is no UTF-8 is
/// taken as Latin-1, control characters become blanks.
[[nodiscard]] std::string clean_name(std::string name);

/// Whether a text in UTF-8 holds a line break or another character, but for tabs, that is none to be read.
[[nodiscard]] bool has_control_character(const std::string& text);

/// The lines of a text file without their line breaks (LF, CR LF). @throws InputError  as read_text_file()
[[nodiscard]] std::vector<std::string> read_text_lines(const std::string& path);

/// A cell and where it begins.
struct Cell {
  std::string text;  ///< without quotation marks and blanks around it
  int column = 1;    ///< byte of the line, from 1
};

/// The cells of a line. Quotation marks (") keep separators; doubled they stand for one.
/// @param separator  ' ': any number of blanks and tabs
/// @throws RangeError  for a quotation mark that is not closed
[[nodiscard]] std::vector<Cell> split_cells(const std::string& line, char separator);

/// A name as two people may write it: without blanks around it, hard blanks as blanks, both mu as the micro sign.
[[nodiscard]] std::string plain_name(std::string text);

/// The number in a cell. Its message says what is wrong: decimal comma or point, thousands separators, text.
/// @throws RangeError  when the cell is no finite number
[[nodiscard]] double parse_number(const std::string& text, char decimal);

}  // namespace driftwright
