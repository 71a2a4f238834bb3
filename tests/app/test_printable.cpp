// Texts from elsewhere do nothing to a terminal, a line or a report.
#include "app/base/printable.h"
#include "tests/support/catch.h"

using app::printable;

TEST_CASE("a text on its way to a terminal keeps its letters and loses what acts", "[printable]") {
  CHECK(printable("λ = 10, 東京 \U0001f600.png") == "λ = 10, 東京 \U0001f600.png");
  CHECK(printable("") == "");
  CHECK(printable(std::string("a\0b", 3)) == "a?b");
  CHECK(printable("new\nline\r\t\x1b[31m\x7f") == "new?line???[31m?");
  CHECK(printable("\xc2\x9b"
                  "31m\xc2\x85") == "?31m?");  // C1: a control sequence of one character; next line
  CHECK(printable("a\u2028b\u2029c\u202egnp\u2066") == "a?b?c?gnp?");  // separators of lines, directions of writing
}

TEST_CASE("what is no UTF-8 becomes a question mark a byte", "[printable]") {
  CHECK(printable("bad\xff\xfe.png") == "bad??.png");
  CHECK(printable("\xed\xa0\x80") == "???");  // a surrogate
  CHECK(printable("\xe0\x80\x80") == "???");  // longer than need be
  CHECK(printable("\xc0\xaf") == "??");
  CHECK(printable("\xf4\x90\x80\x80") == "????");  // beyond U+10FFFF
  CHECK(printable("\xef\xbf\xbe") == "???");       // U+FFFE
  CHECK(printable("\xef\xb7\x90") == "???");       // U+FDD0
  CHECK(printable("\xf0\x9f\xbf\xbf") == "????");  // U+1FFFF
  CHECK(printable("cut \xe2\x82") == "cut ??");
  CHECK(printable("\x80 \xe2\x28\xa1") == "? ?(?");
  CHECK(printable("\xf4\x8f\xbf\xbd") == "\xf4\x8f\xbf\xbd");  // U+10FFFD, the last
}
