// docs/errors.md and the sources name the same codes of errors, in both directions, with the HTTP status that the
// service gives them.
#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <sstream>

#include "core/track/track_estimate.hpp"
#include "server/api/problem.hpp"
#include "server/http/errors.hpp"
#include "tests/contract/error_codes.hpp"

namespace roadfix::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Pair;

const fs::path kRoot = ROADFIX_SOURCE_DIR;

/// Literals that look like a code and are none.
const std::set<std::string> kOtherWords{// headers and what they hold
                                        "content-disposition", "content-encoding", "content-length", "content-type",
                                        "if-none-match", "last-event-id", "no-cache", "no-store", "transfer-encoding",
                                        "cross-site", "sec-fetch-site", "x-forwarded-for", "x-forwarded-proto",
                                        "x-gzip", "x-request-id",
                                        // a format of files, a unit
                                        "roadfix-calibration-2", "us-ft"};

std::string read(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw std::runtime_error("cannot read " + file.string());
  return {std::istreambuf_iterator<char>(in), {}};
}

/// What the sources of the program say.
const ErrorCodes& program() {
  static const ErrorCodes kProgram = [] {
    std::map<std::string, std::string> sources;
    for (const char* top : {"core", "tiles", "server", "schema", "cli"}) {
      for (const auto& entry : fs::recursive_directory_iterator(kRoot / top)) {
        const fs::path& path = entry.path();
        if (path.extension() != ".cpp" && path.extension() != ".hpp") continue;
        sources[path.lexically_relative(kRoot).generic_string()] = read(path);
      }
    }
    std::vector<std::string> texts;
    for (const auto& [path, text] : sources) texts.push_back(text);
    const auto classes = error_classes(texts);
    ErrorCodes codes;
    for (const auto& [path, text] : sources) add_error_codes(codes, classes, path, text);
    return codes;
  }();
  return kProgram;
}

/// The second cell of each row "| `code` | ... |", by its code: the status, "-" where it cannot come over HTTP, or
/// where no code of the table can what it means.
std::multimap<std::string, std::string> rows_of(const std::string& markdown) {
  static const std::regex kRow(R"re(\| `([a-z0-9-]+)` \| ([^|]*) \|.*)re");
  std::multimap<std::string, std::string> rows;
  std::istringstream in(markdown);
  std::smatch match;
  for (std::string line; std::getline(in, line);) {
    if (std::regex_match(line, match, kRow)) rows.emplace(match[1], match[2]);
  }
  return rows;
}

std::multimap<std::string, std::string> documented() { return rows_of(read(kRoot / "docs" / "errors.md")); }

/// The reasons of answers that are no errors have their table where it says how they come about.
std::multimap<std::string, std::string> reasons() { return rows_of(read(kRoot / "docs" / "calibration.md")); }

/// Why a step of a track claims no place: told where the conditions of a claim are.
bool is_reason_of_a_track(const std::string& word) {
  static const std::string kDocument = read(kRoot / "docs" / "tracks.md");
  return value_of(kUnclaimed, word) && kDocument.find("`" + word + "`") != std::string::npos;
}

int status_as(const std::string& type, const std::string& code) {
  if (type == "InvalidInput") return api::status_of(InvalidInput(code, ""));
  if (type == "InvalidField") return api::status_of(http::InvalidField(code, "", ""));
  if (type == "NotFound") return api::status_of(NotFound(code, ""));
  if (type == "LimitExceeded") return api::status_of(LimitExceeded(code, ""));
  if (type == "CorruptData") return api::status_of(CorruptData(code, ""));
  if (type == "IoFailure") return api::status_of(IoFailure(code, ""));
  if (type == "Interrupted") return api::status_of(Interrupted(code, ""));
  if (type == "InUse") return api::status_of(InUse(code, ""));
  throw std::runtime_error("which status has " + type + "?");
}

TEST(ErrorCodes, AreAllListed) {
  const auto rows = documented();
  const auto others = reasons();
  EXPECT_GT(program().words.size(), 200u);
  for (const auto& [code, files] : program().words) {
    EXPECT_TRUE(rows.contains(code) || others.contains(code) || is_reason_of_a_track(code) ||
                kOtherWords.contains(code))
        << *files.begin() << " has \"" << code << "\": give it a line in docs/errors.md, or if it is no code, one here";
  }
}

TEST(ErrorCodes, ThatAreListedAreThrown) {
  std::string last;
  for (const auto& [code, status] : documented()) {
    EXPECT_TRUE(program().words.contains(code)) << "docs/errors.md lists `" << code << "`, and no source has it";
    EXPECT_NE(code, last) << "docs/errors.md lists `" << code << "` twice";
    last = code;
  }
  for (const std::string& word : kOtherWords) {
    EXPECT_TRUE(program().words.contains(word)) << "no source has \"" << word << "\" any more: take it out here";
  }
}

TEST(ErrorCodes, AreListedWithTheirStatus) {
  static const std::regex kStatus("[1-5][0-9][0-9]");
  int with_status = 0;
  for (const auto& [code, cell] : documented()) {
    const auto thrown_as = program().classes.find(code);
    if (thrown_as == program().classes.end() || !std::regex_match(cell, kStatus)) continue;
    std::set<std::string> possible;
    for (const std::string& type : thrown_as->second) possible.insert(std::to_string(status_as(type, code)));
    EXPECT_THAT(possible, Contains(cell)) << "the status of `" << code << "` in docs/errors.md";
    ++with_status;
  }
  EXPECT_GT(with_status, 80);
}

TEST(ErrorCodes, AreWrittenOut) { EXPECT_THAT(program().complaints, IsEmpty()); }

ErrorCodes codes_of(std::string_view source) {
  ErrorCodes codes;
  add_error_codes(codes, {"Error", "InvalidInput", "IoFailure"}, "x.cpp", source);
  return codes;
}

TEST(ErrorCodeScanner, FindsCodesWhereverTheyStand) {
  const ErrorCodes codes = codes_of(R"(
    throw InvalidInput("plain-code", fmt::format("{} of an-other {}", a + b));
    throw InvalidInput(deep ? "first-choice" : "second-choice", "text");
    inline constexpr const char* kCode = "code-of-constant";
    throw InvalidInput(kCode, "text");
    return Doubt{"code-of-field", "text"};
    IoFailure not_there(const std::string& name) {
      return {"code-of-function", name};
    }
  )");
  EXPECT_THAT(codes.words.size(), 6u);
  for (const char* code : {"plain-code", "first-choice", "second-choice", "code-of-constant", "code-of-field"}) {
    EXPECT_THAT(codes.words, Contains(Pair(code, ElementsAre("x.cpp"))));
  }
  EXPECT_THAT(codes.classes, Contains(Pair("second-choice", ElementsAre("InvalidInput"))));
  EXPECT_THAT(codes.classes, Contains(Pair("code-of-function", ElementsAre("IoFailure"))));
  EXPECT_THAT(codes.complaints, IsEmpty());
}

TEST(ErrorCodeScanner, SeesNoCodesInCommentsOptionsAndTablesOfStatus) {
  const ErrorCodes codes = codes_of(R"(
    // throw InvalidInput("in-comment", "text");
    /* "in-comment" */ char quote = '"'; int many = 40'000;
    add("--option-name", "Text with a-hyphen", "x", R"sql(SELECT "a-b")sql");
    {"in-table", 404},
  )");
  EXPECT_THAT(codes.words, IsEmpty());
}

TEST(ErrorCodeScanner, RefusesCodesThatCannotBeFound) {
  EXPECT_THAT(codes_of(R"(throw InvalidInput(kind + "-missing", "text");)").complaints,
              Contains(HasSubstr("x.cpp:1: the code is put together")));
  EXPECT_THAT(codes_of(R"(throw IoFailure(fmt::format("{}-missing", kind), "text");)").complaints,
              Contains(HasSubstr("put together")));
  EXPECT_THAT(codes_of(R"(throw InvalidInput("interrupted", "text");)").complaints, ElementsAre(HasSubstr("no code")));
}

TEST(ErrorCodeScanner, KnowsTheClassesThatAreMadeWithACode) {
  EXPECT_THAT(
      error_classes({"class B : public A {\n  B(std::string code, int x);\n};\nclass C : public A {\n  C();\n};\n",
                     "class A : public Error {\n  using Error::Error;\n};\n",
                     "class E : public D {\n  using D::D;\n};\n"}),
      ElementsAre("A", "B", "Error"));
}

}  // namespace
}  // namespace roadfix::testing
