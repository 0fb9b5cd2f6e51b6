// The strict CSV: what it reads, and the line it says for each thing it does not.
#include "common/image/csv.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "common/error.hpp"
#include "common/image/atomic_file.hpp"
#include "temporary.hpp"

using namespace welkin;
using Catch::Matchers::Contains;
using Catch::Matchers::Equals;

namespace {
const std::vector<std::string> kRays = {"altitude_km", "view_zenith_deg"};
CsvTable parse(const std::string& text) { return parse_csv(text, "rays.csv", kRays, {"note"}); }
}  // namespace

TEST_CASE("CSV: columns by name, comments, blanks, CR LF", "[csv]") {
  const CsvTable t = parse(
      "# rays\n#\n\nnote, view_zenith_deg ,altitude_km\r\n sunset here ,\t89.9, +5e-4\r\n# "
      "between\nb,-0,2.\n\n,90.10,1e3");
  CHECK(t.rows == 3);
  CHECK(t.column("altitude_km") == std::vector<double>{0.0005, 2.0, 1000.0});
  CHECK(t.column("view_zenith_deg") == std::vector<double>{89.9, 0.0, 90.1});
  CHECK(t.text("note") == std::vector<std::string>{"sunset here", "b", ""});
  CHECK(t.text("view_zenith_deg")[2] == "90.10");  // as written
  CHECK(t.names == std::vector<std::string>{"note", "view_zenith_deg", "altitude_km"});
  CHECK_THROWS_WITH(t.column("sun"), Contains("'sun'") && Contains("note, view_zenith_deg, altitude_km"));
  CHECK_THROWS_WITH(t.column("note"), Contains("text"));
}

TEST_CASE("CSV: each fault has its place and its line", "[csv]") {
  const std::string head = "altitude_km,view_zenith_deg\n";
  CHECK_THROWS_WITH(parse(""),
                    Equals("rays.csv: empty: expected a line of column names and at least one row below it"));
  CHECK_THROWS_WITH(parse("# only this\n\n"), Contains("empty"));
  CHECK_THROWS_WITH(parse(head), Contains("at least one row"));
  CHECK_THROWS_WITH(parse("altitude_km,zenith\n1,2\n"),
                    Equals("rays.csv:1:1: column 'view_zenith_deg' is missing: there are altitude_km, zenith"));
  CHECK_THROWS_WITH(parse(head + "1,2\n1,2,3\n"), Equals("rays.csv:3:5: 3 fields where the header has 2"));
  CHECK_THROWS_WITH(parse(head + "1\n"), Equals("rays.csv:2:1: 1 fields where the header has 2"));
  CHECK_THROWS_WITH(parse(head + "1, x\n"), Equals("rays.csv:2:4: view_zenith_deg 'x' is not a finite number"));
  for (const char* bad : {"nan", "inf", "-inf", "NaN", "", "1e999", "0x10", "1 2", "1;2", "--1"})
    CHECK_THROWS_WITH(parse(head + "1," + bad + "\n"),
                      Contains("rays.csv:2:3: view_zenith_deg '" + std::string(bad) + "' is not a finite number"));
  CHECK_THROWS_WITH(parse(head + "1,\"2\"\n"), Equals("rays.csv:2:3: quotes are not accepted"));
  CHECK_THROWS_WITH(parse("altitude_km,altitude_km\n"), Equals("rays.csv:1:13: column 'altitude_km' occurs twice"));
  CHECK_THROWS_WITH(parse("altitude_km,,b\n"), Equals("rays.csv:1:13: a column without a name"));
  CHECK_THROWS_WITH(parse(std::string(300, ',')), Contains("301 columns"));
  CHECK_THROWS_WITH(parse(head + "1," + std::string(1000, 'x')),
                    Contains("xxx...'"));                                  // short, whatever the file holds
  CHECK_THROWS_WITH(parse(head + "1,\x1b[2J\n"), Contains("'\\x1b[2J'"));  // and harmless to a terminal
  std::string many = head;
  for (int i = 0; i < 1'000'001; ++i) many += "1,2\n";
  CHECK_THROWS_WITH(parse(many), Equals("rays.csv:1000002:1: more than the 1000000 rows accepted"));
}

TEST_CASE("CSV: a byte order mark and every kind of line end are read as if they were not there", "[csv]") {
  const std::string plain = "altitude_km,view_zenith_deg\n1,2\n3,4\n";
  const std::vector<double> wanted{1.0, 3.0};
  for (const char* end : {"\n", "\r\n", "\r"})
    for (const char* mark : {"", "\xEF\xBB\xBF"}) {
      std::string text = mark;
      for (const char c : plain) text += c == '\n' ? std::string(end) : std::string(1, c);
      const CsvTable t = parse(text);
      CHECK(t.names == std::vector<std::string>{"altitude_km", "view_zenith_deg"});
      CHECK(t.column("altitude_km") == wanted);
      CHECK_THROWS_WITH(parse(text + "1,x"), Contains("rays.csv:4:3: view_zenith_deg 'x'"));
    }
  CHECK_THROWS_WITH(parse("\xFF\xFE"
                          "a,b"),
                    Equals("rays.csv: UTF-16 text; accepted is UTF-8"));
}

TEST_CASE("CSV: noise ends in Error or success, nothing else", "[csv]") {
  std::mt19937 random(1);
  const std::string letters = "altitude_km,view_zenith_deg\n1,2\n#\r\n \t\"-+.e9,,\n\n",
                    good = "altitude_km,view_zenith_deg\n1,2\n3,4\n";
  int read = 0;
  for (int round = 0; round < 20000; ++round) {
    std::string text = good;
    for (size_t i = 0; i < 1 + random() % 5; ++i) {
      const size_t at = random() % text.size();
      if (random() % 2)
        text[at] = random() % 8 ? letters[random() % letters.size()] : static_cast<char>(random());
      else
        text.insert(at, 1, letters[random() % letters.size()]);
    }
    try {
      const CsvTable t = parse(text);
      for (const double v : t.column("altitude_km")) REQUIRE(std::isfinite(v));
      ++read;
    } catch (const Error& error) {
      REQUIRE(std::string(error.what()).find('\n') == std::string::npos);
    }
  }
  CHECK(read > 100);
  CHECK(read < 19000);
}

TEST_CASE("CSV: what is written reads back to the last bit", "[csv]") {
  const TemporaryDirectory dir;
  std::vector<std::vector<std::string>> rows;
  std::vector<double> values;
  std::mt19937_64 random(2);
  while (rows.size() < 200) {
    const double v = std::ldexp(static_cast<double>(random()), static_cast<int>(random() % 600) - 300);
    values.push_back(v);
    rows.push_back({csv_number(v), "-0.5"});
  }
  write_csv(dir / "a.csv", {"device: x\ny"}, kRays, rows);
  const CsvTable t = read_csv(dir / "a.csv", kRays);
  CHECK(t.column("altitude_km") == values);
  CHECK(read_file(dir / "a.csv", 1 << 20).substr(0, 14) == "# device: x y\n");
  CHECK_THROWS_AS(write_csv(dir / "b.csv", {}, kRays, {{"1"}}), Error);
  CHECK_THROWS_AS(write_csv(dir / "b.csv", {}, kRays, {{"1", "a,b"}}), Error);
  CHECK_FALSE(std::filesystem::exists(dir / "b.csv"));
  CHECK_THROWS_WITH(read_csv(dir / "none.csv", {}), Contains("none.csv"));
  CHECK_THROWS_WITH(read_csv(dir.path, {}), Contains("directory"));
}
