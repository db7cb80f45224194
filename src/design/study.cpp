#include "design/study.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <set>
#include <sstream>

#include "design/toml_values.h"

namespace catoptric::design {
namespace {

/// Reads one study with the place of every value at hand.
class StudyReader {
 public:
  StudyReader(std::string_view text, const std::filesystem::path& name)
      : folder_(name.parent_path()), name_(name.string()), table_(parse_toml(text, name_)) {}

  Study read() {
    check_keys(table_, "");
    Study study{text(table_, "", "title").value_or(""),
                text(table_, "", "command").value_or("design") == "design",
                {}};
    scene_ = text(table_, "", "scene");
    const toml::array* runs = table_.get_as<toml::array>("runs");
    if (!runs || runs->empty())
      throw InputError({"the study has no runs", name_, "each [[runs]] is one variation of the scene",
                        "[[runs]]\nname = \"1\""});
    std::set<std::string> names;
    for (const toml::node& node : *runs) {
      const toml::table* run = node.as_table();
      if (!run)
        throw InputError({"runs holds something else than tables", where(node), "", "write [[runs]]"});
      study.runs.push_back(read_run(*run));
      if (!names.insert(study.runs.back().name).second)
        throw InputError({fmt::format("two runs are named \"{}\"", study.runs.back().name), where(node),
                          "each run has a folder of its own name", ""});
    }
    return study;
  }

 private:
  std::string where(const toml::node& node) const {
    return fmt::format("{}:{}", name_, node.source().begin.line);
  }

  void check_keys(const toml::table& table, const std::string& prefix) const {
    for (const auto& [key, node] : table) {
      const std::string path = prefix + std::string(key.str());
      if (path == "runs" || find_key(study_keys(), path)) continue;
      const std::string near = nearest_path(study_keys(), path);
      throw InputError({fmt::format("unknown key {}", path), where(node), "every key must be known",
                        near.empty() ? "" : fmt::format("did you mean {}?", near)});
    }
  }

  std::optional<std::string> text(const toml::table& table, const std::string& prefix,
                                  const std::string& key) const {
    const toml::node* node = table.get(key);
    if (!node) return std::nullopt;
    const std::string path = prefix + key;
    return std::get<std::string>(checked(*find_key(study_keys(), path), path, *node, where(*node)).value);
  }

  StudyRun read_run(const toml::table& table) const {
    check_keys(table, "runs.");
    StudyRun run;
    run.name = text(table, "runs.", "name").value_or("");
    const auto fit = [](unsigned char c) { return std::isalnum(c) || c == '-' || c == '_' || c == '.'; };
    if (run.name.empty() || run.name.front() == '.' || !std::all_of(run.name.begin(), run.name.end(), fit))
      throw InputError({fmt::format("\"{}\" is no name for a run", run.name), where(table),
                        "it names a folder: letters, digits, - _ .", "name = \"1\""});
    const auto scene = text(table, "runs.", "scene");
    if (!scene && !scene_)
      throw InputError({fmt::format("run {} has no scene", run.name), where(table),
                        "neither the study nor the run names one", "scene = \"scene.toml\""});
    run.scene = folder_ / scene.value_or(scene_.value_or(""));
    if (const toml::node* set = table.get("set")) read_changes(*set, "", run.changes);
    if (const toml::node* reference = table.get("reference")) read_reference(*reference, run);
    return run;
  }

  void read_changes(const toml::node& node, const std::string& prefix, std::vector<Override>& changes) const {
    const toml::table* table = node.as_table();
    if (!table)
      throw InputError({"set is no table", where(node), "", "set = {\"search.acceleration\" = 2.0}"});
    for (const auto& [key, value] : *table) {
      const std::string path = prefix + std::string(key.str());
      if (value.is_table()) {
        read_changes(value, path + ".", changes);
        continue;
      }
      std::ostringstream out;
      value.visit([&](const auto& typed) { out << typed; });
      changes.push_back({path, out.str(), where(value)});
    }
  }

  void read_reference(const toml::node& node, StudyRun& run) const {
    const toml::table* table = node.as_table();
    if (!table) throw InputError({"reference is no table", where(node), "", "reference = {w1 = 1.0}"});
    for (const auto& [key, value] : *table) {
      const auto number = value.value<double>();
      if (!number)
        throw InputError({fmt::format("reference {} is no number", key.str()), where(value), "", ""});
      run.reference.emplace_back(std::string(key.str()), *number);
    }
  }

  std::filesystem::path folder_;
  std::string name_;
  toml::table table_;
  std::optional<std::string> scene_;
};

}  // namespace

Study read_study(const std::filesystem::path& file) { return parse_study(read_text(file), file); }

Study parse_study(std::string_view text, const std::filesystem::path& name) {
  return StudyReader(text, name).read();
}

Scene study_scene(const StudyRun& run, const std::vector<Override>& more) {
  std::vector<Override> changes = run.changes;
  changes.insert(changes.end(), more.begin(), more.end());
  return read_scene(run.scene, changes);
}

}  // namespace catoptric::design
