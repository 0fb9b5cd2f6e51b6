// Strict CSV reading and writing. See csv.hpp.
#include "common/image/csv.hpp"

#include <algorithm>

#include "common/error.hpp"
#include "common/image/atomic_file.hpp"
#include "common/knobs.hpp"
#include "common/scene/one_line.hpp"

namespace welkin {
namespace {

constexpr size_t kMaxFile = size_t{256} << 20;
constexpr size_t kMaxRows = 1'000'000;
constexpr size_t kMaxColumns = 256;

// The fields, without the blanks around them; each still lies in the line, which tells its column.
std::vector<std::string_view> split(std::string_view line) {
  std::vector<std::string_view> fields;
  for (size_t start = 0; start <= line.size();) {
    const std::string_view field = line.substr(start, std::min(line.find(',', start), line.size()) - start);
    const size_t first = field.find_first_not_of(" \t"), last = field.find_last_not_of(" \t");
    fields.push_back(first == field.npos ? field.substr(0, 0) : field.substr(first, last - first + 1));
    start += field.size() + 1;
  }
  return fields;
}

std::string shown(std::string_view text) { return one_line(text, 100); }

}  // namespace

size_t CsvTable::index(std::string_view name) const {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) fail("no column '{}': there are {}", name, fmt::join(names, ", "));
  return static_cast<size_t>(found - names.begin());
}

const std::vector<double>& CsvTable::column(std::string_view name) const {
  const size_t i = index(name);
  if (numbers[i].size() != rows) fail("column '{}' holds text, not numbers", name);
  return numbers[i];
}

const std::vector<std::string>& CsvTable::text(std::string_view name) const { return fields[index(name)]; }

CsvTable parse_csv(std::string_view contents, const std::string& file, const std::vector<std::string>& required,
                   const std::vector<std::string>& text) {
  CsvTable table;
  const auto has = [](const auto& list, std::string_view name) {
    return std::find(list.begin(), list.end(), name) != list.end();
  };
  size_t number = 0;
  if (contents.starts_with("\xEF\xBB\xBF")) contents.remove_prefix(3);  // the mark that spreadsheets put before UTF-8
  if (contents.starts_with("\xFF\xFE") || contents.starts_with("\xFE\xFF"))
    fail("{}: UTF-16 text; accepted is UTF-8", file);
  while (!contents.empty()) {
    ++number;
    const std::string_view line = contents.substr(0, contents.find_first_of("\r\n"));
    contents.remove_prefix(line.size());
    contents.remove_prefix(contents.starts_with("\r\n") ? 2 : std::min<size_t>(1, contents.size()));
    if (line.find_first_not_of(" \t") == line.npos || line.front() == '#') continue;
    const auto refuse = [&](std::string_view at, const std::string& why) {
      fail("{}:{}:{}: {}", file, number, at.data() - line.data() + 1, why);
    };
    if (const size_t quote = line.find('"'); quote != line.npos) refuse(line.substr(quote), "quotes are not accepted");
    const std::vector<std::string_view> fields = split(line);
    if (table.names.empty()) {
      if (fields.size() > kMaxColumns)
        refuse(line, fmt::format("{} columns; accepted are up to {}", fields.size(), kMaxColumns));
      for (const std::string_view field : fields) {
        if (field.empty()) refuse(field, "a column without a name");
        if (has(table.names, field)) refuse(field, fmt::format("column '{}' occurs twice", shown(field)));
        table.names.emplace_back(field);
      }
      const std::string all = shown(fmt::format("{}", fmt::join(table.names, ", ")));
      for (const std::string& name : required)
        if (!has(table.names, name)) refuse(line, fmt::format("column '{}' is missing: there are {}", name, all));
      table.numbers.resize(fields.size());
      table.fields.resize(fields.size());
      continue;
    }
    if (fields.size() != table.names.size())
      refuse(fields.back(), fmt::format("{} fields where the header has {}", fields.size(), table.names.size()));
    if (++table.rows > kMaxRows) refuse(line, fmt::format("more than the {} rows accepted", kMaxRows));
    for (size_t i = 0; i < fields.size(); ++i) {
      table.fields[i].emplace_back(fields[i]);
      double value = 0.0;
      if (has(text, table.names[i])) continue;
      if (!parse_number(fields[i], value))
        refuse(fields[i], fmt::format("{} '{}' is not a finite number", table.names[i], shown(fields[i])));
      table.numbers[i].push_back(value);
    }
  }
  if (table.rows == 0) fail("{}: empty: expected a line of column names and at least one row below it", file);
  return table;
}

CsvTable read_csv(const std::filesystem::path& file, const std::vector<std::string>& required,
                  const std::vector<std::string>& text) {
  return parse_csv(read_file(file, kMaxFile), file.string(), required, text);
}

void write_csv(const std::filesystem::path& file, const std::vector<std::string>& comments,
               const std::vector<std::string>& names, const std::vector<std::vector<std::string>>& rows) {
  std::string out;
  for (const std::string& comment : comments) {
    out += "# ";
    for (const char c : comment) out += c == '\n' || c == '\r' ? ' ' : c;  // one comment, one line
    out += '\n';
  }
  const auto line = [&](const std::vector<std::string>& fields) {
    if (fields.size() != names.size())
      fail("{}: a row of {} fields under {} columns", file.string(), fields.size(), names.size());
    for (const std::string& field : fields)
      if (field.find_first_of(",\"\r\n") != std::string::npos)
        fail("{}: the field '{}' cannot stand in a CSV", file.string(), shown(field));
    out += fmt::format("{}\n", fmt::join(fields, ","));
  };
  line(names);
  for (const auto& row : rows) line(row);
  write_file_atomically(file, out);
}

std::string csv_number(double value) { return fmt::format("{}", value); }

}  // namespace welkin
