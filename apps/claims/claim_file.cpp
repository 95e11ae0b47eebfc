// SPDX-License-Identifier: MIT
#include "apps/claims/claim_file.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <sstream>

#include "apps/runtime/embedded_files.h"
#include "io/disk/file.h"
#include "io/text/line_reader.h"
#include "io/text/toml_file.h"
#include "kernel/number_text.h"

namespace corral {

const EmbeddedFiles& embedded_claims();

namespace {

template <class Value>
using Words = std::vector<std::pair<std::string, Value>>;

/// Every measure that has a mean, and what else there is.
Words<Quantity> quantities() {
  Words<Quantity> words;
  for (const Measure& measure : measures())
    if (measure.absent != Absent::Infinite && measure.average != Average::Pooled)
      words.push_back({measure.word(), {Quantity::Kind::Measure, &measure}});
  words.push_back({"value", {Quantity::Kind::Value, nullptr}});
  words.push_back({"agreement", {Quantity::Kind::Agreement, nullptr}});
  words.push_back({"keypoints", {Quantity::Kind::KeypointDensity, nullptr}});
  return words;
}

const Words<Take> kTakes = {{"each level", Take::EachLevel},
                            {"mean", Take::Mean},
                            {"range", Take::Range},
                            {"rise", Take::Rise},
                            {"relative drop", Take::RelativeDrop},
                            {"largest rise", Take::LargestRise},
                            {"largest fall", Take::LargestFall},
                            {"least step", Take::LeastStep},
                            {"spearman", Take::Spearman},
                            {"slope", Take::Slope},
                            {"correlation", Take::Correlation},
                            {"wins", Take::Wins},
                            {"mean rank", Take::MeanRank},
                            {"percentile", Take::Percentile},
                            {"count", Take::Count}};
const Words<bool> kOver = {{"levels", false}, {"pairs", true}};
const Words<Quantifier> kQuantifiers = {
    {"every", Quantifier::Every}, {"most", Quantifier::Most}, {"half", Quantifier::Half}, {"one", Quantifier::One}};
const Words<Operand::Kind> kOperands = {{"all", Operand::Kind::All},
                                        {"max", Operand::Kind::Largest},
                                        {"median", Operand::Kind::Median},
                                        {"others", Operand::Kind::Others},
                                        {"it", Operand::Kind::Alone}};

template <class Value>
std::vector<std::string> names_of(const Words<Value>& words) {
  std::vector<std::string> names;
  for (const auto& [name, value] : words) names.push_back(name);
  return names;
}

[[noreturn]] void fail_word(const TomlTable& table, const std::string& key, const std::string& word,
                            const std::vector<std::string>& known) {
  std::string expected;
  for (const std::string& name : known) expected += (expected.empty() ? "" : ", ") + name;
  const std::string nearest = nearest_name(word, known);
  table.fail(key, "found " + quoted(word) +
                      (nearest.empty() ? ", expected one of " + expected : ", did you mean " + quoted(nearest) + "?"));
}

template <class Value>
Value word_of(const TomlTable& table, const std::string& key, const Words<Value>& words, Value fallback) {
  const std::optional<std::string> word = table.text(key);
  if (!word) return fallback;
  for (const auto& [name, value] : words)
    if (name == *word) return value;
  fail_word(table, key, *word, names_of(words));
}

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> pieces;
  std::istringstream stream(text);
  for (std::string piece; std::getline(stream, piece, separator);)
    if (!piece.empty()) pieces.push_back(piece);
  return pieces;
}

int whole_number(const TomlTable& table, const std::string& key, int otherwise, int least) {
  const std::int64_t value = table.integer(key).value_or(otherwise);
  if (value < least || value > 1'000'000)
    table.fail(key, "out of range, expected " + std::to_string(least) + " .. 1000000");
  return static_cast<int>(value);
}

/// One number for all methods together: of none of them can anything be said.
bool has_one_number(const ClaimPart& part) { return part.of.is_of_pairs() || part.take == Take::Correlation; }

bool asks_for_methods(const ClaimPart& part) {
  const auto is_of_methods = [](const Operand& operand) {
    return operand.kind == Operand::Kind::Methods || operand.kind == Operand::Kind::Rank;
  };
  const auto compares_methods = [&](const Comparison& comparison) {
    return is_of_methods(comparison.left) || is_of_methods(comparison.right);
  };
  return !part.largest.empty() || !part.smallest.empty() || part.take == Take::Wins || part.take == Take::MeanRank ||
         std::any_of(part.is.begin(), part.is.end(), compares_methods);
}

/// Reads the parts of one claim.
class PartReader {
 public:
  PartReader(const ClaimBook& book, TomlTable table) : book_(book), table_(std::move(table)) {}

  ClaimPart read() const {
    table_.only({"experiment", "experiments", "with",     "of",    "take", "over",        "where",        "at",
                 "from",       "to",          "first",    "last",  "lead", "inlier_from", "inlier_below", "percent",
                 "is",         "largest",     "smallest", "after", "ties", "note"});
    ClaimPart part;
    part.experiments = table_.texts("experiments");
    if (const auto experiment = table_.text("experiment")) part.experiments.push_back(*experiment);
    if (part.experiments.empty()) table_.fail("experiment", "missing");
    part.with = table_.texts("with");
    part.of = word_of(table_, "of", quantities(), Quantity());
    part.take = word_of(table_, "take", kTakes, Take::EachLevel);
    part.over_pairs = word_of(table_, "over", kOver, false);
    part.where = word_of(table_, "where", kQuantifiers, Quantifier::Every);
    part.from = table_.number("from").value_or(part.from);
    part.to = table_.number("to").value_or(part.to);
    if (const auto at = table_.number("at")) part.from = part.to = *at;
    part.first = interval("first");
    part.last = interval("last");
    part.lead = table_.flag("lead").value_or(false);
    part.inlier_from = table_.number("inlier_from").value_or(part.inlier_from);
    part.inlier_below = table_.number("inlier_below").value_or(part.inlier_below);
    part.percent = table_.number("percent").value_or(part.percent);
    for (const std::string& text : table_.texts("is")) part.is.push_back(comparison(text));
    part.largest = methods("largest", table_.texts("largest"));
    part.smallest = methods("smallest", table_.texts("smallest"));
    part.after = whole_number(table_, "after", 0, 0);
    part.ties = table_.flag("ties").value_or(false);
    part.is_note = table_.flag("note").value_or(false);
    check(part);
    return part;
  }

 private:
  void check(const ClaimPart& part) const {
    if (part.is.empty() && part.largest.empty() && part.smallest.empty())
      table_.fail("is", "missing: a rule needs is, largest or smallest");
    const bool is_change = part.take == Take::Rise || part.take == Take::RelativeDrop;
    if (part.with.empty() ? part.take == Take::Correlation : part.take != Take::Correlation && !is_change)
      table_.fail("with", "goes with correlation, which needs it, rise and relative drop");
    const bool only_pairs = part.take == Take::Percentile || part.take == Take::Count;
    if (part.over_pairs ? !only_pairs && part.take != Take::Mean && part.take != Take::Spearman : only_pairs)
      table_.fail("over", "'pairs' goes with mean, spearman, percentile and count; the last two need it");
    if (has_one_number(part) && asks_for_methods(part))
      table_.fail("is", "the rule has a single number, not one for each grouper, expected 'it' in its place");
    if (part.after > static_cast<int>(book_.methods.size())) table_.fail("after", "there are fewer groupers");
    if (!(part.percent >= 0 && part.percent <= 100)) table_.fail("percent", "expected 0 to 100");
  }

  std::optional<std::pair<double, double>> interval(const std::string& key) const {
    const std::vector<double> ends = table_.numbers(key);
    if (ends.empty()) return std::nullopt;
    if (ends.size() != 2 || !(ends[0] <= ends[1])) table_.fail(key, "expected [low, high]");
    return std::make_pair(ends[0], ends[1]);
  }

  int method(const std::string& key, const std::string& name) const {
    const auto found = std::find(book_.methods.begin(), book_.methods.end(), name);
    if (found == book_.methods.end()) {
      std::vector<std::string> known = names_of(kOperands);
      known.insert(known.end(), book_.methods.begin(), book_.methods.end());
      fail_word(table_, key, name, known);
    }
    return static_cast<int>(found - book_.methods.begin());
  }

  std::vector<int> methods(const std::string& key, const std::vector<std::string>& names) const {
    std::vector<int> places;
    for (const std::string& name : names) places.push_back(method(key, name));
    return places;
  }

  Operand operand(const std::string& text) const {
    for (const auto& [name, kind] : kOperands)
      if (name == text) return {kind, {}};
    for (const std::string function : {"mean", "rank"}) {
      if (text.rfind(function + "(", 0) != 0 || text.back() != ')') continue;
      const std::size_t start = function.size() + 1;
      const std::vector<int> places = methods("is", split(text.substr(start, text.size() - start - 1), ','));
      if (places.empty() || (function == "rank" && places.size() != 1)) table_.fail("is", "in " + quoted(text));
      return {function == "rank" ? Operand::Kind::Rank : Operand::Kind::Methods, places};
    }
    return {Operand::Kind::Methods, {method("is", text)}};
  }

  std::optional<double> constant(const std::string& word) const {
    const std::optional<double> number = word == "tau" ? std::optional<double>(book_.tau) : parse_double(word);
    return number && std::isfinite(*number) ? number : std::nullopt;
  }

  /// LEFT (> | >= | < | <=) [FACTOR *] RIGHT [(+ | -) OFFSET]
  Comparison comparison(const std::string& text) const {
    std::vector<std::string> words = split(text, ' ');
    const auto malformed = [&] {
      table_.fail("is", quoted(text) + " is not a comparison such as 'gc >= 0.5 * ss - tau'");
    };
    if (words.size() < 3) malformed();
    Comparison comparison;
    comparison.left = operand(words[0]);
    if (words[1] != ">" && words[1] != ">=" && words[1] != "<" && words[1] != "<=") malformed();
    comparison.is_greater = words[1][0] == '>';
    comparison.or_equal = words[1].size() == 2;
    words.erase(words.begin(), words.begin() + 2);
    if (words.size() > 2 && words[1] == "*") {
      if (!constant(words[0])) malformed();
      comparison.factor = *constant(words[0]);
      words.erase(words.begin(), words.begin() + 2);
    }
    if (const auto value = constant(words[0]))
      comparison.offset = *value;
    else
      comparison.right = operand(words[0]);
    if (words.size() == 3 && (words[1] == "+" || words[1] == "-") && constant(words[2]))
      comparison.offset += (words[1] == "+" ? 1 : -1) * *constant(words[2]);
    else if (words.size() != 1)
      malformed();
    if (comparison.left.kind == Operand::Kind::Constant || comparison.right.kind == Operand::Kind::Rank) malformed();
    if (comparison.left.kind == Operand::Kind::Rank &&
        (comparison.right.kind != Operand::Kind::Constant || std::abs(comparison.offset) > 1000))
      table_.fail("is", "in " + quoted(text) + ": expected a rank from 1 on its right side");
    return comparison;
  }

  const ClaimBook& book_;
  TomlTable table_;
};

}  // namespace

ClaimBook parse_claims(const std::string& path, const std::string& text) {
  const TomlTable root = TomlTable::parse(path, text);
  root.only({"methods", "tau", "time_tau", "least_pairs", "claim", "slips"});
  ClaimBook book;
  book.methods = root.texts("methods");
  if (book.methods.size() < 2) root.fail("methods", "expected two or more");
  book.tau = root.number("tau").value_or(book.tau);
  book.time_tau = root.number("time_tau").value_or(book.time_tau);
  book.least_pairs = whole_number(root, "least_pairs", book.least_pairs, 1);
  book.slips = root.texts("slips");
  std::set<std::string> ids;
  for (const TomlTable& table : root.tables("claim")) {
    table.only({"id", "text", "note", "parts"});
    Claim claim{table.text("id").value_or(""), table.text("text").value_or(""), table.text("note").value_or(""), {}};
    if (claim.id.empty() || !ids.insert(claim.id).second) table.fail("id", "expected an id that no other claim has");
    for (const TomlTable& part : table.tables("parts")) claim.parts.push_back(PartReader(book, part).read());
    const auto is_note = [](const ClaimPart& part) { return part.is_note; };
    if (std::all_of(claim.parts.begin(), claim.parts.end(), is_note)) table.fail("parts", "expected one or more rules");
    book.claims.push_back(claim);
  }
  return book;
}

ClaimBook read_claims(const std::string& path) { return parse_claims(path, read_file(path)); }

ClaimBook built_in_claims() { return parse_claims("claims.toml", embedded_claims().at("claims.toml")); }

}  // namespace corral
