// Writes a libFuzzer dictionary of all that a scene or a study file may hold, from the tables of keys.
// Usage: fuzz_dictionary > scene.dict

#include <fmt/format.h>

#include <set>
#include <string>

#include "design/keys.h"
#include "fuzz/support/chance.h"

int main() {
  std::set<std::string> words{"\xEF\xBB\xBF",
                              "\r\n",
                              "[[",
                              "]]",
                              "[[runs]]\n",
                              "\"\"\"",
                              "'''",
                              "{",
                              "}",
                              "\\u0000",
                              "true",
                              "false",
                              "nan",
                              "inf",
                              "-inf",
                              "1979-05-27T07:32:00Z",
                              "\x1e",
                              "a.a.a.a.a.a.a",
                              "[variables.w1]\n",
                              "step = 1\n",
                              "lower = 0.05\n",
                              "upper = 20\n",
                              "[variables.\"source.z\"]\n",
                              "degree 4",
                              "spans 2",
                              "r2",
                              "w1",
                              "z0"};
  for (const auto keys : {catoptric::design::scene_keys(), catoptric::design::study_keys()})
    for (const auto& key : keys) {
      const std::string path(key.path);
      const auto dot = path.rfind('.');
      words.insert(path + "=");
      words.insert(path.substr(dot == std::string::npos ? 0 : dot + 1) + " = ");
      if (dot != std::string::npos) words.insert("[" + path.substr(0, dot) + "]\n");
      for (const auto choice : key.choices) words.insert("\"" + std::string(choice) + "\"");
      if (!key.standard.empty()) words.insert(std::string(key.standard));
    }
  for (const std::string& number : catoptric::fuzz::hostile_numbers())
    if (!number.empty()) words.insert(number);
  for (const std::string& word : words) {
    std::string escaped;
    for (const char c : word) escaped += fmt::format("\\x{:02X}", static_cast<unsigned char>(c));
    fmt::print("\"{}\"\n", escaped);
  }
}
