// Strict CSV for tables of numbers: '#' lines are comments, then one line of column names, then rows of as many fields.
//
// Fields are separated by commas; blanks around them, blank lines, every kind of line end (LF, CR LF, CR) and a
// byte order mark before UTF-8 are accepted; quotes are not.
// Every field is a finite decimal number unless its column is asked for as text.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace welkin {

struct CsvTable {
  std::vector<std::string> names;                // the file's columns, in order
  std::vector<std::vector<double>> numbers;      // [column][row]; empty for a text column
  std::vector<std::vector<std::string>> fields;  // [column][row], as written (to repeat a number unchanged)
  size_t rows = 0;

  size_t index(std::string_view name) const;                       // Error listing the columns there are
  const std::vector<double>& column(std::string_view name) const;  // Error also if it is text
  const std::vector<std::string>& text(std::string_view name) const;
};

// `required` columns must be there, others may be; `text` names the columns that hold text. Accepted: 1..1,000,000
// rows, up to 256 columns and 256 MiB. Errors say file:line:column, where column is that of the field's first
// character.
CsvTable read_csv(const std::filesystem::path& file, const std::vector<std::string>& required,
                  const std::vector<std::string>& text = {});
CsvTable parse_csv(std::string_view contents, const std::string& file, const std::vector<std::string>& required,
                   const std::vector<std::string>& text = {});

// Writes comments, names and rows, atomically. Error if a row's width differs or a field holds ',', '"' or a line
// break.
void write_csv(const std::filesystem::path& file, const std::vector<std::string>& comments,
               const std::vector<std::string>& names, const std::vector<std::vector<std::string>>& rows);

// The shortest text that reads back as the same double.
std::string csv_number(double value);

}  // namespace welkin
