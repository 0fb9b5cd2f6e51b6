// Knob declarations as JSON, from which the book's tables are woven.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "common/knobs.hpp"

namespace welkin::measure {

// {"chapter": …, "knobs": [{"name", "unit", "meaning", "minimum", "maximum", "default", "choices", "ladder"}]}
void write_knobs_json(const std::filesystem::path& file, const std::string& chapter, const std::vector<Knob>& knobs);

}  // namespace welkin::measure
