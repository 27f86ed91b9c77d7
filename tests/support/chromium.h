// SPDX-License-Identifier: Apache-2.0
// A page in headless Chromium: what it does when somebody uses it.
#pragma once

#include <cstdlib>
#include <fstream>
#include <string>

#include "dcnn/core/json.h"
#include "support/process.h"

namespace dcnn::test {

inline bool has_chromium() { return std::system("command -v chromium > /dev/null 2>&1") == 0; }

/// Loads a page, runs `script` (the body of a function that returns an object) when it has loaded,
/// and gives that object, with `errors`: what the console and uncaught exceptions said.
inline Json browse(const std::string& html, const std::string& script, int width = 1000,
                   const std::string& flags = "") {
  const TemporaryFolder folder;
  const std::string before =
      "<script>window.faults = []; addEventListener('error', e => faults.push(e.message));"
      "for (const kind of ['error', 'warn']) console[kind] = (...words) => "
      "faults.push(words.join(' '));"
      "</script>";
  const std::string after =
      "<script>addEventListener('load', () => { let result; try { result = (() => {" + script +
      "})(); } catch (e) { faults.push(String(e)); result = {}; } result.errors = faults;"
      "parent.postMessage(encodeURIComponent(JSON.stringify(result)), '*'); });</script>";
  std::string page = html;
  page.insert(page.find("<head>") + 6, before);
  page.insert(page.rfind("</body>"), after);
  std::ofstream(folder / "page.html") << page;
  // Chromium's window is never narrower than 500 pixels, a frame in it is.
  std::ofstream(folder / "frame.html")
      << "<!DOCTYPE html><body style='margin:0'><pre "
         "id=\"result\"></pre><script>addEventListener('message', e => {"
         "document.getElementById('result').textContent = e.data; });</script><iframe "
         "style='border:0' width='"
      << width << "' height='1200' src='page.html'></iframe></body>";
  const std::string command =
      "cd '" + folder.path().string() +
      "' && HOME=$PWD timeout 60 chromium --headless --no-sandbox --disable-gpu "
      "--hide-scrollbars --window-size=1200,1300 " +
      flags + " --virtual-time-budget=2000 --dump-dom frame.html > dom.html 2> chromium.txt";
  if (std::system(command.c_str()) != 0) return Json{{"errors", {"chromium did not run"}}};
  const std::string dom = slurp(folder / "dom.html"), mark = "<pre id=\"result\">";
  const auto begin = dom.rfind(mark);
  if (begin == dom.npos) return Json{{"errors", {"the frame did not load"}}};
  const std::string text =
      dom.substr(begin + mark.size(), dom.find("</pre>", begin) - begin - mark.size());
  if (text.empty()) return Json{{"errors", {"the page's script did not run"}}};
  std::string plain;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '%' && i + 2 < text.size()) {
      plain += static_cast<char>(std::stoi(text.substr(i + 1, 2), nullptr, 16));
      i += 2;
    } else {
      plain += text[i];
    }
  }
  return Json::parse(plain);
}

}  // namespace dcnn::test
