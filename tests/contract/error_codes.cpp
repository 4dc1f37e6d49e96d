#include "tests/contract/error_codes.hpp"

#include <algorithm>
#include <cctype>
#include <regex>

namespace roadfix::testing {
namespace {

struct Token {
  enum class Kind { kWord, kText, kSign };
  Kind kind = Kind::kSign;
  std::string text;  ///< of a literal what lies between its quotes, as written
  int line = 0;
};

using Tokens = std::vector<Token>;

bool is_word(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }

/// Words (and numbers), literals, and everything else one by one.
class Scanner {
 public:
  explicit Scanner(std::string_view source) : source_(source) {}

  Tokens tokens() {
    while (at_ < source_.size()) next();
    return std::move(tokens_);
  }

 private:
  void next() {
    const std::string_view rest = source_.substr(at_);
    if (rest.starts_with("//")) return skip(end_of("\n"));
    if (rest.starts_with("/*")) return skip(end_of("*/"));
    if (rest.starts_with("R\"")) return raw_literal();
    if (rest.front() == '"' || rest.front() == '\'') return literal(rest.front());
    if (std::isspace(static_cast<unsigned char>(rest.front())) != 0) return skip(at_ + 1);
    std::size_t end = at_ + 1;
    if (is_word(rest.front())) {
      // A number may be written as 40'000.
      const bool number = std::isdigit(static_cast<unsigned char>(rest.front())) != 0;
      while (end < source_.size() && (is_word(source_[end]) || (number && source_[end] == '\''))) ++end;
    }
    add(is_word(rest.front()) ? Token::Kind::kWord : Token::Kind::kSign, at_, end, end);
  }

  void literal(char quote) {
    std::size_t end = at_ + 1;
    while (end < source_.size() && source_[end] != quote) end += source_[end] == '\\' ? 2U : 1U;
    if (quote == '\'') return skip(end + 1);
    add(Token::Kind::kText, at_ + 1, end, end + 1);
  }

  void raw_literal() {
    const std::size_t open = source_.find('(', at_);
    const std::string close = ")" + std::string(source_.substr(at_ + 2, open - at_ - 2)) + "\"";
    const std::size_t end = source_.find(close, open);
    add(Token::Kind::kText, open + 1, end, end + close.size());
  }

  std::size_t end_of(std::string_view mark) const {
    const std::size_t found = source_.find(mark, at_);
    return found == std::string_view::npos ? source_.size() : found + mark.size();
  }

  void add(Token::Kind kind, std::size_t begin, std::size_t end, std::size_t after) {
    tokens_.push_back({kind, std::string(source_.substr(begin, end - begin)), line_});
    skip(after);
  }

  void skip(std::size_t to) {
    to = std::min(to, source_.size());
    line_ += static_cast<int>(std::ranges::count(source_.substr(at_, to - at_), '\n'));
    at_ = to;
  }

  std::string_view source_;
  std::size_t at_ = 0;
  int line_ = 1;
  Tokens tokens_;
};

bool is_sign(const Tokens& tokens, std::size_t i, std::string_view sign) {
  return i < tokens.size() && tokens[i].kind == Token::Kind::kSign && tokens[i].text == sign;
}

bool opens(const Tokens& tokens, std::size_t i) { return is_sign(tokens, i, "(") || is_sign(tokens, i, "{"); }

/// {"map-not-found", 404}
bool is_status_entry(const Tokens& tokens, std::size_t i) {
  static const std::regex kStatus("[1-5][0-9][0-9]");
  return i > 0 && is_sign(tokens, i - 1, "{") && is_sign(tokens, i + 1, ",") && i + 2 < tokens.size() &&
         std::regex_match(tokens[i + 2].text, kStatus) && is_sign(tokens, i + 3, "}");
}

/// The tokens from `begin` up to the comma or bracket that ends the first argument.
Tokens first_argument(const Tokens& tokens, std::size_t begin) {
  int depth = 0;
  std::size_t end = begin;
  for (; end < tokens.size(); ++end) {
    if (depth == 0 && (is_sign(tokens, end, ",") || is_sign(tokens, end, ")") || is_sign(tokens, end, "}"))) break;
    if (opens(tokens, end)) ++depth;
    if (is_sign(tokens, end, ")") || is_sign(tokens, end, "}")) --depth;
  }
  return {tokens.begin() + static_cast<std::ptrdiff_t>(begin), tokens.begin() + static_cast<std::ptrdiff_t>(end)};
}

bool is_code(const std::string& text) {
  static const std::regex kCode("[a-z][a-z0-9]*(-[a-z0-9]+)+");
  return std::regex_match(text, kCode);
}

/// Where tokens make an error of a class, the place after the bracket; else 0. Of `return {...}` in a function that
/// returns one (`returned`) too.
std::size_t arguments_of_error(const Tokens& tokens, std::size_t i, const std::set<std::string>& classes,
                               std::string& made, const std::string& returned) {
  if (tokens[i].kind != Token::Kind::kWord) return 0;
  if (tokens[i].text == "return" && is_sign(tokens, i + 1, "{") && !returned.empty()) {
    made = returned;
    return i + 2;
  }
  if (!classes.contains(tokens[i].text) || !opens(tokens, i + 1)) return 0;
  // `class NotFound : public Error {` and `catch (const Error& e)` make none.
  if (i > 0 && (tokens[i - 1].text == "public" || tokens[i - 1].text == "class")) return 0;
  made = tokens[i].text;
  return i + 2;
}

}  // namespace

void add_error_codes(ErrorCodes& codes, const std::set<std::string>& classes, const std::string& path,
                     std::string_view source) {
  const Tokens tokens = Scanner(source).tokens();
  std::string returned;  // by the function that is being read, where it is an error
  for (std::size_t i = 0; i < tokens.size(); ++i) {
    const Token& token = tokens[i];
    if (token.kind == Token::Kind::kText && is_code(token.text) && !is_status_entry(tokens, i)) {
      codes.words[token.text].insert(path);
    }
    if (is_sign(tokens, i, "}") && (i + 1 == tokens.size() || tokens[i + 1].line > token.line + 1)) returned.clear();
    if (classes.contains(token.text) && i + 2 < tokens.size() && tokens[i + 1].kind == Token::Kind::kWord &&
        is_sign(tokens, i + 2, "(")) {
      returned = token.text;
    }
    std::string made;
    const std::size_t begin = arguments_of_error(tokens, i, classes, made, returned);
    if (begin == 0) continue;
    const auto complain = [&](const std::string& what) {
      codes.complaints.push_back(path + ":" + std::to_string(token.line) + ": " + what);
    };
    for (const Token& part : first_argument(tokens, begin)) {
      if (part.text == "+" || part.text == "format") complain("the code is put together: write it out");
      if (part.kind != Token::Kind::kText) continue;
      if (!is_code(part.text)) complain("\"" + part.text + "\" is no code of several words with hyphens");
      codes.classes[part.text].insert(made);
    }
  }
}

std::set<std::string> error_classes(const std::vector<std::string>& sources) {
  static const std::regex kDerived(R"(class (\w+) : public (?:\w+::)*(\w+) \{)");
  std::set<std::string> derived{"Error"};
  std::set<std::string> made_with_code{"Error"};
  for (std::size_t before = 0; before != derived.size();) {
    before = derived.size();
    for (const std::string& source : sources) {
      for (auto it = std::sregex_iterator(source.begin(), source.end(), kDerived); it != std::sregex_iterator(); ++it) {
        const std::string name = (*it)[1];
        const std::string base = (*it)[2];
        if (!derived.contains(base)) continue;
        derived.insert(name);
        const auto begin = static_cast<std::size_t>(it->position());
        const std::string body = source.substr(begin, source.find("\n};", begin) - begin);
        if (body.find("using " + base + "::" + base + ";") != std::string::npos ||
            body.find(" " + name + "(std::string code, ") != std::string::npos) {
          made_with_code.insert(name);
        }
      }
    }
  }
  return made_with_code;
}

}  // namespace roadfix::testing
