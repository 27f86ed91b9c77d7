// SPDX-License-Identifier: Apache-2.0
// man(7) text of a command.
#include "support/option_table.h"

namespace dcnn {
namespace {

/// Text for roff: backslashes and dashes escaped, no line that begins as a request.
std::string roff(const std::string& text) {
  std::string out;
  bool at_start = true;
  for (const char c : text) {
    if (at_start && (c == '.' || c == '\'')) out += "\\&";
    if (c == '\\') {
      out += "\\e";
    } else if (c == '-') {
      out += "\\-";
    } else {
      out += c;
    }
    at_start = c == '\n';
  }
  return out;
}

/// Text whose line breaks stay.
std::string paragraph(const std::string& text) {
  std::string out;
  for (const char c : text) out += c == '\n' ? std::string("\n.br\n") : std::string(1, c);
  return out;
}

}  // namespace

std::string manual_page(const OptionTable& table) {
  std::string title = table.name;
  for (char& c : title) c = static_cast<char>(c >= 'a' && c <= 'z' ? c - 'a' + 'A' : c);
  std::string page = ".TH " + roff(title) + " 1 \"\" \"DCNN Toolkit " + table.version +
                     "\" \"User Commands\"\n.SH NAME\n" + roff(table.name) + " \\- " +
                     roff(table.summary) + "\n.SH SYNOPSIS\n.B " + roff(table.name) + "\n";
  for (const OptionRow& row : table.rows) {
    if (row.required || row.is_argument()) page += roff(row.usage()) + "\n";
  }
  page += "[options]\n.SH EXAMPLES\n.nf\n" + roff(table.examples) +
          (table.examples.ends_with('\n') ? "" : "\n") + ".fi\n.SH OPTIONS\n";
  for (const std::string& group : table.groups()) {
    page += ".SS " + roff(group) + "\n";
    for (const OptionRow& row : table.rows) {
      if (row.group != group) continue;
      page += ".TP\n.B " + roff(row.usage()) + "\n" + paragraph(roff(row.words())) + "\n";
    }
  }
  return page +
         ".SH EXIT STATUS\n0 done, 1 failure, 2 wrong usage, 3 bad data, 4 bad model, 75 "
         "interrupted with the state saved.\n.SH SEE ALSO\n.BR dcnn (1)\n";
}

}  // namespace dcnn
