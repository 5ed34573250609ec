// What every failure of the program has to look like.
#pragma once

#include <gmock/gmock.h>

#include <string>
#include <vector>

#include "cli/run_program.h"

namespace kinebase::test {

// Nothing on stdout, one line on stderr that begins with "error: " and holds all of `parts`.
inline void ExpectOneError(const ProgramResult& result, int exit_code,
                           const std::vector<std::string>& parts) {
  EXPECT_EQ(result.exit_code, exit_code);
  EXPECT_EQ(result.out, "");
  ASSERT_EQ(result.ErrorLines().size(), 1U) << result.err;
  EXPECT_TRUE(result.err.starts_with("error: ")) << result.err;
  for (const std::string& part : parts) EXPECT_THAT(result.err, ::testing::HasSubstr(part));
}

// "name:type" of each field, in order. Types are those of JSON; whole numbers are "integer".
inline std::vector<std::string> FieldsOf(const nlohmann::ordered_json& object) {
  std::vector<std::string> fields;
  for (const auto& [name, value] : object.items()) {
    fields.push_back(name + ':' + (value.is_number_integer() ? "integer" : value.type_name()));
  }
  return fields;
}

}  // namespace kinebase::test
