// SPDX-License-Identifier: MIT
#include "apps/scoreboard/site.h"

#include <algorithm>
#include <set>

#include "apps/runtime/embedded_files.h"
#include "apps/runtime/json.h"
#include "apps/runtime/text_table.h"

namespace corral {

const EmbeddedFiles& embedded_scoreboard();  // the files of apps/scoreboard/site

namespace {

std::string html(const std::string& text) {
  std::string safe;
  for (const char c : text)
    safe += c == '&'    ? "&amp;"
            : c == '<'  ? "&lt;"
            : c == '>'  ? "&gt;"
            : c == '"'  ? "&quot;"
            : c == '\'' ? "&#39;"
                        : std::string(1, c);
  return safe;
}

/// A part of a file name: letters, digits and . _ + - ; others become underscores.
std::string file_part(const std::string& text) {
  std::string part = text;
  for (char& c : part)
    if (std::isalnum(static_cast<unsigned char>(c)) == 0 && std::string("._+-").find(c) == std::string::npos) c = '_';
  return part;
}

std::string page_name(const Board& board) { return file_part(board.experiment + "-" + board.dataset) + ".html"; }
std::string card_name(const std::string& method) { return "method-" + file_part(method) + ".html"; }

std::string link(const std::string& file, const std::string& text, const std::string& hint = "") {
  return "<a href=\"" + html(file) + "\"" + (hint.empty() ? "" : " title=\"" + html(hint) + "\"") + ">" + html(text) +
         "</a>";
}

std::string page(const std::string& title, const std::string& body) {
  const EmbeddedFiles& files = embedded_scoreboard();
  return "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
         "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
         "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'\">\n"
         "<title>" +
         html(title) + "</title>\n<style>\n" + files.at("board.css") + "</style>\n</head>\n<body>\n<main>\n<h1>" +
         html(title) + "</h1>\n" + body + "</main>\n<script>\n" + files.at("board.js") +
         "</script>\n</body>\n</html>\n";
}

std::string cell(const std::optional<double>& value, int decimals) {
  if (!value) return "<td class=\"none\" data-value=\"\">-</td>";
  return "<td data-value=\"" + to_text(*value) + "\">" + fixed(*value, decimals) + "</td>";
}

/// A share with its interval behind it, and a bar.
std::string share_cell(const std::optional<SuccessShare>& share) {
  if (!share) return "<td class=\"none\" data-value=\"\">-</td>";
  return "<td class=\"share\" data-value=\"" + to_text(share->success) + "\" title=\"" + std::to_string(share->pairs) +
         " tables, 95 %: " + fixed(share->low, 2) + " to " + fixed(share->high, 2) +
         "\"><span class=\"bar\" style=\"--share:" + fixed(share->success, 4) + "\"></span><span class=\"number\">" +
         fixed(share->success, 2) + "</span></td>";
}

std::string head(const std::string& text, bool is_number = true) {
  return "<th scope=\"col\" aria-sort=\"none\"><button type=\"button\"" + std::string(is_number ? " data-number" : "") +
         ">" + html(text) + "</button></th>";
}

bool has_confidence(const Board& board) {
  return std::any_of(board.rows.begin(), board.rows.end(),
                     [](const BoardRow& row) { return row.confidence.has_value(); });
}

MethodFacts facts_of(const FactsByMethod& facts, const std::string& method) {
  const auto found = facts.find(method);
  return found == facts.end() ? MethodFacts() : found->second;
}

std::string words_cell(const std::string& text) { return "<td class=\"words\">" + html(text) + "</td>"; }

std::string contract_text(const MethodFacts& known) {
  if (!known.is_checked) return "";
  return known.broken.empty() ? "holds" : "breaks " + std::to_string(known.broken.size());
}

std::string board_page(const Board& board, const FactsByMethod& facts) {
  std::string table =
      "<p>" + std::to_string(board.tables) +
      " tables. Success: the refined pose has a mean error of at most 5 pr; its Wilson interval of 95 % is in the last "
      "columns. "
      "MB: peak memory for 10,000 matches. "
      "Columns in per cent: the tables with that share of correct matches. Shaded: methods not distinguishable from "
      "the best, whose success lies in their interval. Select a column header to sort by it.</p>\n<div class=\"wide\"><table "
      "class=\"sortable\">\n<thead><tr>" +
      head("rank") + head("method", false) + head("success");
  std::vector<std::size_t> bins;  // with any table
  for (std::size_t bin = 0; bin < kCorrectShares.size(); ++bin)
    if (std::any_of(board.rows.begin(), board.rows.end(),
                    [&](const BoardRow& row) { return row.by_share[bin].has_value(); }))
      bins.push_back(bin), table += head(correct_share_text(bin));
  table += head("precision") + head("recall") + head("F1") + head("time ms");
  if (has_confidence(board)) table += head("confidence");
  table += head("MB") + head("needs", false) + head("deterministic", false) + head("contract", false) +
           head("licence", false) + head("run by", false) + head("low") + head("high") + "</tr></thead>\n<tbody>\n";
  double best = 0;
  for (const BoardRow& row : board.rows)
    if (row.rank == 1) best = row.all.success;
  for (const BoardRow& row : board.rows) {
    const bool is_oracle = row.method == "oracle";
    const MethodFacts known = facts_of(facts, row.method);
    const bool is_ranked = row.rank > 0, is_tie = is_ranked && row.all.high >= best;
    table += std::string("<tr") +
             (is_oracle ? " class=\"oracle\""
              : is_tie  ? " class=\"tie\""
                        : "") +
             "><td data-value=\"" + (is_ranked ? std::to_string(row.rank) : "") + "\">" +
             (is_ranked ? std::to_string(row.rank) : "") + "</td><th scope=\"row\">" +
             (is_oracle ? "all correct matches" : link(card_name(row.method), row.method, known.title)) + "</th>" +
             share_cell(row.all.pairs > 0 ? std::optional<SuccessShare>(row.all) : std::nullopt);
    for (const std::size_t bin : bins) table += share_cell(row.by_share[bin]);
    table += cell(row.precision, 3) + cell(row.recall, 3) + cell(row.f1, 3) + cell(row.median_ms, 2);
    if (has_confidence(board)) table += cell(row.confidence, 3);
    table += cell(known.memory_10k_mb, 1) + words_cell(known.needs) +
             words_cell(known.determinism.empty() ? "" : "yes") + words_cell(contract_text(known)) +
             words_cell(known.licence) +
             words_cell(is_oracle          ? ""
                        : row.is_submitted ? std::string("submitted") + (row.is_time_stated ? ", time as stated" : "")
                                           : "Corral") +
             cell(is_oracle || is_ranked ? std::optional<double>(row.all.low) : std::nullopt, 3) +
             cell(is_oracle || is_ranked ? std::optional<double>(row.all.high) : std::nullopt, 3) + "</tr>\n";
  }
  return page(board.title + ", " + board.dataset,
              "<p>" + link("index.html", "All boards") + "</p>\n" + table + "</tbody></table></div>\n");
}

/// The share of correct matches at which a method is farthest behind the best.
std::string weak_spot(const Board& board, const BoardRow& row) {
  double most = 0;
  std::string text;
  for (std::size_t bin = 0; bin < row.by_share.size(); ++bin) {
    if (!row.by_share[bin]) continue;
    for (const BoardRow& other : board.rows) {
      if (other.method == "oracle" || !other.by_share[bin]) continue;
      const double behind = other.by_share[bin]->success - row.by_share[bin]->success;
      if (behind <= most) continue;
      most = behind;
      text = "On tables with " + correct_share_text(bin) + " correct matches it registers " +
             fixed(row.by_share[bin]->success, 2) + ", " + other.method + " " + fixed(other.by_share[bin]->success, 2) +
             " (" + std::to_string(row.by_share[bin]->pairs) + " tables).";
    }
  }
  return text.empty() ? "No method is ahead of it at any share of correct matches." : text;
}

std::string fact_row(const std::string& name, const std::string& value) {
  return value.empty() ? "" : "<dt>" + html(name) + "</dt><dd>" + html(value) + "</dd>\n";
}

std::string card_page(const std::string& method, const std::vector<Board>& boards, const FactsByMethod& facts) {
  const MethodFacts known = facts_of(facts, method);
  std::string memory;
  if (known.memory_1k_mb && known.memory_10k_mb)
    memory =
        fixed(*known.memory_1k_mb, 1) + " MB for 1,000 matches, " + fixed(*known.memory_10k_mb, 1) + " MB for 10,000";
  std::string body = "<p>" + link("index.html", "All boards") + "</p>\n<dl>\n" +
                     fact_row("Principle", known.principle) + fact_row("Needs", known.needs) +
                     fact_row("Determinism", known.determinism) + fact_row("Memory", memory) +
                     fact_row("Licence", known.licence) + fact_row("Where", known.url);
  if (known.is_checked) {
    std::string broken;
    for (const std::string& check : known.broken) broken += (broken.empty() ? "breaks: " : ", ") + check;
    body += fact_row("Contract", broken.empty() ? "every check holds" : broken);
  }
  body += "</dl>\n";
  for (const Board& board : boards) {
    const BoardRow* row = board.row_of(method);
    if (!row) continue;
    body += "<h2>" + link(page_name(board), board.title + ", " + board.dataset) + "</h2>\n<p>" +
            (row->rank > 0 ? "Rank " + std::to_string(row->rank) : "Not ranked, as it applies to no table") +
            ": registers " + fixed(row->all.success, 2) + " of " + std::to_string(row->all.pairs) +
            " tables (95 %: " + fixed(row->all.low, 2) + " to " + fixed(row->all.high, 2) + ")" +
            (row->is_submitted ? "; its answers were submitted" : "") + ".</p>\n<p>" + html(weak_spot(board, *row)) +
            "</p>\n";
  }
  return page(known.title.empty() ? method : known.title, body);
}

std::string index_page(const std::vector<Board>& boards) {
  std::string body =
      "<p>Methods that tell correct from incorrect matches, all on the same tables, judged by whether the pose aligns "
      "the "
      "surfaces.</p>\n<div class=\"wide\"><table>\n<thead><tr><th scope=\"col\">board</th><th "
      "scope=\"col\">tables</th><th "
      "scope=\"col\">methods</th><th scope=\"col\">first</th><th scope=\"col\">success</th></tr></thead>\n<tbody>\n";
  for (const Board& board : boards) {
    std::string first;
    std::optional<SuccessShare> share;
    for (const BoardRow& row : board.rows)
      if (row.rank == 1)
        first += (first.empty() ? "" : ", ") + link(card_name(row.method), row.method), share = row.all;
    body += "<tr><th scope=\"row\">" + link(page_name(board), board.title + ", " + board.dataset) + "</th><td>" +
            std::to_string(board.tables) + "</td><td>" +
            std::to_string(board.rows.size() - (board.row_of("oracle") ? 1 : 0)) + "</td><td>" + first + "</td>" +
            share_cell(share) + "</tr>\n";
  }
  return page("Scoreboard of correspondence groupers", body + "</tbody></table></div>\n");
}

Json json_of(const std::optional<SuccessShare>& share) {
  if (!share) return nullptr;
  return {{"success", share->success}, {"tables", share->pairs}, {"low", share->low}, {"high", share->high}};
}

}  // namespace

std::vector<FileContent> scoreboard_site(const std::vector<Board>& boards, const FactsByMethod& facts,
                                         const std::string& folder) {
  std::vector<FileContent> files = {{folder + "/index.html", index_page(boards)}};
  std::set<std::string> methods;
  for (const Board& board : boards) {
    files.push_back({folder + "/" + page_name(board), board_page(board, facts)});
    for (const BoardRow& row : board.rows)
      if (row.method != "oracle") methods.insert(row.method);
  }
  for (const std::string& method : methods)
    files.push_back({folder + "/" + card_name(method), card_page(method, boards, facts)});
  files.push_back({folder + "/scores.json", scoreboard_json(boards, facts)});
  return files;
}

std::string scoreboard_json(const std::vector<Board>& boards, const FactsByMethod& facts) {
  Json list = Json::array(), known = Json::object();
  for (const Board& board : boards) {
    Json rows = Json::array();
    for (const BoardRow& row : board.rows) {
      Json bins = Json::array();
      for (const auto& share : row.by_share) bins.push_back(json_of(share));
      rows.push_back({{"method", row.method},
                      {"submitted", row.is_submitted},
                      {"rank", row.rank > 0 ? Json(row.rank) : Json(nullptr)},
                      {"all", json_of(row.all)},
                      {"by_share", bins},
                      {"precision", json_or_null(row.precision)},
                      {"recall", json_or_null(row.recall)},
                      {"f1", json_or_null(row.f1)},
                      {"confidence", json_or_null(row.confidence)},
                      {"median_ms", json_or_null(row.median_ms)},
                      {"time_stated", row.is_time_stated}});
    }
    list.push_back(
        {{"experiment", board.experiment}, {"dataset", board.dataset}, {"tables", board.tables}, {"methods", rows}});
  }
  for (const auto& [method, each] : facts)
    known[method] = {{"title", each.title},
                     {"needs", each.needs},
                     {"licence", each.licence},
                     {"url", each.url},
                     {"determinism", each.determinism},
                     {"memory_1k_mb", json_or_null(each.memory_1k_mb)},
                     {"memory_10k_mb", json_or_null(each.memory_10k_mb)},
                     {"broken", each.is_checked ? Json(each.broken) : Json(nullptr)}};
  return json_text({{"shares_percent", kCorrectShares}, {"boards", list}, {"methods", known}});
}

}  // namespace corral
