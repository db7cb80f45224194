#include "rayfiles/detail/utf32.h"

#include <catch2/catch.hpp>

#include "support/ray_bytes.h"

using namespace catoptric::rayfiles::detail;
using catoptric::test::as_bytes;
using catoptric::test::Bytes;

TEST_CASE("characters of one to four bytes go to UTF-32 and back") {
  const std::string text = "a\xC2\xB5\xE2\x82\xAC\xF0\x9F\x92\xA1";
  const std::string wide = Bytes().wide(U"a\u00b5\u20ac\U0001F4A1", 16).str();
  CHECK(utf32_of_utf8(text) == wide);
  CHECK(utf8_of_utf32(as_bytes(wide)) == text);
}

TEST_CASE("UTF-32 ends at its first NUL, and what is no character is replaced") {
  const std::string replaced = "\xEF\xBF\xBD";
  CHECK(utf8_of_utf32(as_bytes(Bytes().u32('a').u32(0).u32('b').str())) == "a");
  for (const std::uint32_t code : {0xD800u, 0xDFFFu, 0x110000u, 0xFFFFFFFFu})
    CHECK(utf8_of_utf32(as_bytes(Bytes().u32(code).u32('b').str())) == replaced + "b");
}

TEST_CASE("bytes that are no UTF-8 are replaced one by one") {
  const std::string mark = Bytes().u32(0xFFFD).str();
  CHECK(utf32_of_utf8("\xFFz") == mark + Bytes().u32('z').str());
  CHECK(utf32_of_utf8("\xC2") == mark);                        // cut short
  CHECK(utf32_of_utf8("\xC0\x80") == mark + mark);             // longer than need be
  CHECK(utf32_of_utf8("\xED\xA0\x80") == mark + mark + mark);  // a surrogate
  CHECK(utf32_of_utf8("\xF4\x90\x80\x80") == mark + mark + mark + mark);
}
