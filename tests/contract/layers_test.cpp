// Holds the whole tree against the tables of ARCHITECTURE.md: includes and CMake links point only downwards; and what
// compilers and linkers do not look at.
#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>

#include "tests/contract/layer_table.hpp"

namespace roadfix::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

const fs::path kRoot = ROADFIX_SOURCE_DIR;
const std::regex kBuildFile(R"(CMakeLists\.txt)");

std::string read(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw std::runtime_error("cannot read " + file.string());
  return {std::istreambuf_iterator<char>(in), {}};
}

struct SourceFile {
  std::string path;  ///< relative to the project
  std::string text;
};

std::vector<SourceFile> files_in(std::initializer_list<const char*> folders, const std::regex& name) {
  std::vector<SourceFile> files;
  for (const char* folder : folders) {
    for (const auto& entry : fs::recursive_directory_iterator(kRoot / folder)) {
      if (!std::regex_match(entry.path().filename().string(), name)) continue;
      files.push_back({entry.path().lexically_relative(kRoot).generic_string(), read(entry.path())});
    }
  }
  return files;
}

std::vector<SourceFile> product_files(const std::regex& name) {
  return files_in({"core", "tiles", "server", "schema", "cli"}, name);
}

std::vector<std::string> matches(const std::string& text, const std::regex& pattern) {
  std::vector<std::string> found;
  for (auto it = std::sregex_iterator(text.begin(), text.end(), pattern); it != std::sregex_iterator(); ++it) {
    found.push_back((*it)[1]);
  }
  return found;
}

LayerTable project_table() { return parse_layer_table(read(kRoot / "ARCHITECTURE.md")); }

TEST(Layers, EveryIncludeIsAllowedByTheModuleTable) {
  const LayerTable table = project_table();
  const auto files = product_files(std::regex(R"(.*\.(hpp|cpp|in))"));
  EXPECT_GT(files.size(), 20u);
  for (const auto& file : files) EXPECT_THAT(forbidden_includes(table, file.path, file.text), IsEmpty());
}

TEST(Layers, EveryLinkedModuleIsAllowedByTheModuleTable) {
  const LayerTable table = project_table();
  const auto files = product_files(kBuildFile);
  std::map<std::string, std::string> folder_of_target;
  for (const auto& file : files) {
    for (const auto& name : matches(file.text, std::regex(R"(roadfix_module\(\s*(\w+))"))) {
      folder_of_target[name] = fs::path(file.path).parent_path().generic_string();
    }
  }
  for (const auto& file : files) {
    for (const auto& name : matches(file.text, std::regex(R"(roadfix::(\w+))"))) {
      const auto user = table.module_of(fs::path(file.path).parent_path().generic_string());
      ASSERT_TRUE(user) << file.path << " links roadfix::" << name << " but no row of the module table covers it";
      ASSERT_TRUE(folder_of_target.contains(name)) << file.path << " links the unknown module roadfix::" << name;
      const auto used = table.module_of(folder_of_target[name]);
      ASSERT_TRUE(used) << "no row of the module table covers " << folder_of_target[name];
      EXPECT_TRUE(*used == *user || table.modules.at(*user).uses.contains(*used))
          << file.path << " links roadfix::" << name << ", which the row of " << *user << " does not allow";
    }
  }
}

/// The file of the build that a source file belongs to: in its own folder or the nearest above.
std::string build_file_of(const fs::path& path) {
  fs::path folder = path.parent_path();
  while (!fs::exists(kRoot / folder / "CMakeLists.txt")) folder = folder.parent_path();
  return (folder / "CMakeLists.txt").generic_string();
}

/// The headers of all modules of a file of the build, as roadfix_module() takes them.
std::set<std::string> headers_in(const std::string& build_text) {
  std::set<std::string> headers;
  for (const auto& arguments : matches(build_text, std::regex(R"(roadfix_module\(([^)]*)\))"))) {
    std::string keyword;
    for (const auto& word : matches(arguments, std::regex(R"((\S+))"))) {
      if (std::regex_match(word, std::regex("[A-Z_]+"))) {
        keyword = word;
      } else if (keyword == "FILES") {
        headers.insert(word + ".hpp");
      } else if (keyword == "HEADERS") {
        headers.insert(word);
      }
    }
  }
  return headers;
}

TEST(Layers, EveryHeaderBelongsToATargetSoThatItIsCompiledAlone) {
  for (const auto& file : product_files(std::regex(R"(.*\.hpp)"))) {
    const fs::path build_file = build_file_of(file.path);
    const std::string name = fs::path(file.path).lexically_relative(build_file.parent_path()).generic_string();
    EXPECT_TRUE(headers_in(read(kRoot / build_file)).contains(name))
        << "add " << name << " to FILES or HEADERS in " << build_file;
  }
}

TEST(Layers, HeadersOfAModuleAreThoseOfItsPairsAndThoseThatComeAlone) {
  EXPECT_THAT(headers_in("roadfix_module(a\n  FILES b c/d\n  HEADERS e.hpp\n  SOURCES f.cpp\n  LINK g)\nh(i.hpp)"),
              ElementsAre("b.hpp", "c/d.hpp", "e.hpp"));
}

TEST(BuildFiles, AreNoWiderThanClangFormatLetsSourcesBe) {
  std::vector<SourceFile> files = files_in({"core", "tiles", "server", "schema", "cli", "tests"}, kBuildFile);
  files.push_back({"CMakeLists.txt", read(kRoot / "CMakeLists.txt")});
  for (const auto& file : files) {
    EXPECT_THAT(matches(file.text, std::regex("(.{121,})")), IsEmpty()) << "wrap this in " << file.path;
  }
}

/// Types at namespace scope, which stand at the beginning of a line, with their namespace.
std::vector<std::string> types_defined_in(const std::string& header) {
  static const std::regex kDefinition(
      R"((?:^|\n)(?:namespace ([\w:]+) \{|(?:struct|class|enum class) (?:alignas\(.*\) )?(\w+)(?: final)?(?: : [^\n{]*)? \{))");
  std::string scope;
  std::vector<std::string> types;
  for (auto it = std::sregex_iterator(header.begin(), header.end(), kDefinition); it != std::sregex_iterator(); ++it) {
    if ((*it)[1].matched) {
      scope = (*it)[1];
    } else {
      types.push_back(scope + "::" + (*it)[2].str());
    }
  }
  return types;
}

TEST(Headers, GiveOneNameToOneType) {
  // No compiler or linker tells of two types of one name in different files of a program; it may run with either's
  // code.
  std::map<std::string, std::string> header_of;
  for (const auto& file : product_files(std::regex(R"(.*\.hpp)"))) {
    for (const auto& type : types_defined_in(file.text)) {
      const auto [known, is_new] = header_of.emplace(type, file.path);
      EXPECT_TRUE(is_new) << file.path << " defines " << type << ", as " << known->second << " does: rename one";
    }
  }
  EXPECT_GT(header_of.size(), 200u);
}

constexpr const char* kSmallTable = R"(
| Module | Holds | Uses | Libraries |
|---|---|---|---|
| `low` | cells | | |
| `mid/a` | one | `low` | SQLite |
| `mid/b` | two | `low` | |
| `top` | all | `mid` | |

| Library | Headers | Why |
|---|---|---|
| SQLite | `sqlite3.h` | file |
)";

TEST(LayerTable, UsesReachThroughAndAFolderStandsForAllModulesInIt) {
  const LayerTable table = parse_layer_table(kSmallTable);
  EXPECT_THAT(table.modules.at("top").uses, ElementsAre("low", "mid/a", "mid/b"));
  EXPECT_THAT(table.modules.at("mid/a").uses, ElementsAre("low"));
}

TEST(LayerTable, NamesIncludesThatPointUpwardsSidewardsOrToAForeignLibrary) {
  const LayerTable table = parse_layer_table(kSmallTable);
  EXPECT_THAT(
      forbidden_includes(table, "mid/a/x.cpp", "#include <vector>\n#include \"low/y.hpp\"\n#include <sqlite3.h>\n"),
      IsEmpty());
  EXPECT_THAT(forbidden_includes(table, "low/x.cpp", "#include \"top/y.hpp\"\n"),
              ElementsAre(HasSubstr("low/x.cpp includes top/y.hpp")));
  EXPECT_THAT(forbidden_includes(table, "mid/b/x.cpp", "#include \"mid/a/y.hpp\"\n  # include <sqlite3.h>\n").size(),
              2u);
  EXPECT_THAT(forbidden_includes(table, "mid/b/x.cpp", "#include <curl/curl.h>\n"), ElementsAre(HasSubstr("curl")));
  EXPECT_THAT(forbidden_includes(table, "mid/x.cpp", ""), ElementsAre(HasSubstr("no row")));
}

TEST(LayerTable, RefusesCirclesAndUnknownNames) {
  const std::string header =
      "| Library | Headers |\n|---|---|\n| A | `a.h` |\n\n| Module | Holds | Uses | Libraries |\n|---|---|---|---|\n";
  EXPECT_THROW(parse_layer_table(header + "| `x` | | `y` | |\n| `y` | | `x` | |\n"), std::runtime_error);
  EXPECT_THROW(parse_layer_table(header + "| `x` | | `z` | |\n"), std::runtime_error);
  EXPECT_THROW(parse_layer_table(header + "| `x` | | | B |\n"), std::runtime_error);
}

}  // namespace
}  // namespace roadfix::testing
