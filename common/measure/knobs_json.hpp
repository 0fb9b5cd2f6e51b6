// Knob declarations as JSON, from which the book's tables are woven.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "common/knobs.hpp"

namespace welkin::measure {

// {"chapter": …, "knobs": [the members of Knob]}; values of a choice are indices into its names.
void write_knobs_json(const std::filesystem::path& file, const std::string& chapter, const std::vector<Knob>& knobs);

}  // namespace welkin::measure
