/* Foreign text on a terminal: which bytes pass, and none that act. */
#include "support.h"

#include <unistd.h>

#include "base/message.h"
#include "base/text.h"

/* Expected by hand; the UTF-8 of characters by Python: '\u202e'.encode(). */
static const struct {
  const char *raw, *shown;
} texts[] = {
    {"", ""},
    {"plain, \"quoted\", \\ and %s", "plain, \"quoted\", \\ and %s"},
    {"\x1b[31mred\x07", "\\x1b[31mred\\x07"},
    {"a\nb\tc\r", "a\\nb\\tc\\x0d"},
    {"\x7f", "\\x7f"},
    {"\xc2\x9b"
     "31m",
     "\\xc2\\x9b31m"},                                              /* CSI as one character, U+009B */
    {"\xc2\xa0\xc3\xa5\xce\xb3", "\xc2\xa0\xc3\xa5\xce\xb3"},       /* U+00A0, a with ring, gamma */
    {"\xe2\x80\xaegnp.exe", "\\xe2\\x80\\xaegnp.exe"},              /* right to left from here: U+202E */
    {"\xe2\x81\xa6", "\\xe2\\x81\\xa6"},                            /* U+2066 */
    {"\xe2\x80\xa8\xe2\x80\xa9", "\\xe2\\x80\\xa8\\xe2\\x80\\xa9"}, /* U+2028, U+2029 */
    {"\xf0\x9f\x98\x80", "\xf0\x9f\x98\x80"},                       /* U+1F600 */
    {"\x9b"
     "1m",
     "\\x9b1m"},                                  /* CSI in 8 bits, no UTF-8 */
    {"\xc0\x9b", "\\xc0\\x9b"},                   /* ESC in a longer form than allowed */
    {"\xe0\x82\x9b", "\\xe0\\x82\\x9b"},          /* U+009B in a longer form */
    {"\xed\xa0\x80", "\\xed\\xa0\\x80"},          /* half of a pair of UTF-16 */
    {"\xf4\x90\x80\x80", "\\xf4\\x90\\x80\\x80"}, /* beyond U+10FFFF */
    {"\xc3", "\\xc3"},                            /* cut off */
    {"\xe2\x82", "\\xe2\\x82"},
    {"\xe2\x82z", "\\xe2\\x82z"},
};

static void test_what_acts_is_escaped(void **unused)
{
  (void)unused;
  for (size_t k = 0; k < sizeof texts / sizeof *texts; k++)
    assert_string_equal(text_shown(texts[k].raw), texts[k].shown);
}

/* Every string of three bytes: what is shown has no control character, and is UTF-8 (as mbstowcs would have it). */
static void test_nothing_acts(void **unused)
{
  (void)unused;
  for (uint32_t k = 0; k < 1u << 24; k += 1 + k % 5) {
    const char raw[4] = {(char)(k >> 16), (char)(k >> 8), (char)k, '\0'};
    char shown[32];
    text_escape(raw, shown, sizeof shown);
    for (const unsigned char *c = (const unsigned char *)shown; *c; c++)
      if (*c < 0x20 || *c == 0x7f || (*c == 0xc2 && c[1] < 0xa0) ||
          ((*c & 0xc0) == 0x80 && (c == (const unsigned char *)shown || c[-1] < 0x80)) ||
          (*c >= 0xc0 && (c[1] & 0xc0) != 0x80))
        fail_msg("%02x %02x %02x is shown as '%s'", raw[0] & 0xff, raw[1] & 0xff, raw[2] & 0xff, shown);
  }
}

static void test_it_is_cut_between_characters(void **unused)
{
  (void)unused;
  char room[6];
  assert_string_equal(text_escape("ab\xe2\x82\xac", room, 5), "ab");
  assert_string_equal(text_escape("ab\xe2\x82\xac", room, 6), "ab\xe2\x82\xac");
  assert_string_equal(text_escape("ab\x1b", room, 6), "ab");
  assert_string_equal(text_escape("x", room, 1), "");
}

static void test_messages(void **unused)
{
  (void)unused;
  struct message m;
  message_set(&m, "%s: \x1b[2J %d\n", "file\nname", 3);
  assert_string_equal(m.text, "file\\nname: \\x1b[2J 3\\n");
  message_set(&m, "%s again", m.text); /* itself among the arguments */
  assert_string_equal(m.text, "file\\nname: \\x1b[2J 3\\n again");
  message_at(&m, "a\x1b", 1, 2, "%s", "\xff");
  assert_string_equal(m.text, "a\\x1b:1:2: \\xff");
  char longer[3000];
  memset(longer, '\x1b', sizeof longer - 1);
  longer[sizeof longer - 1] = '\0';
  message_set(&m, "%s", longer);
  assert_int_equal(strlen(m.text), 1020);
}

static const char *word_of(const char *word)
{
  static char *text;
  size_t size;
  free(text);
  FILE *stream = open_memstream(&text, &size);
  text_print_word(stream, word);
  fclose(stream);
  return text;
}

/* As bash reads them: by hand. */
static void test_words_for_a_shell(void **unused)
{
  (void)unused;
  assert_string_equal(word_of("runs/a-1.yaml"), "runs/a-1.yaml");
  assert_string_equal(word_of(""), "''");
  assert_string_equal(word_of("a b"), "'a b'");
  assert_string_equal(word_of("$(x) `y` \\"), "'$(x) `y` \\'");
  assert_string_equal(word_of("it's"), "'it'\\''s'");
  assert_string_equal(word_of("\xc3\xa9"), "'\xc3\xa9'");
  assert_string_equal(word_of("a\n'\\"), "$'a\\x0a\\x27\\\\'");
  assert_string_equal(word_of("\xff$(x)"), "$'\\xff$(x)'");
}

/* The longest line, and one of a byte more, which begins with the b. */
static void test_lines_have_a_bound(void **unused)
{
  (void)unused;
  char *line = NULL;
  size_t room = 0;
  FILE *file = tmpfile();
  for (int k = 0; k < 2; k++) {
    for (int i = 0; i < TEXT_LONGEST_LINE - 1; i++)
      fputc('x', file);
    fputs("\nb", file);
  }
  rewind(file);
  assert_int_equal(text_line(&line, &room, file), TEXT_LONGEST_LINE);
  assert_int_equal(line[TEXT_LONGEST_LINE - 1], '\n');
  assert_int_equal(text_line(&line, &room, file), TEXT_TOO_LONG);
  rewind(file);
  fputs("a", file);
  rewind(file);
  assert_int_equal(ftruncate(fileno(file), 3), 0);
  assert_int_equal(text_line(&line, &room, file), 3); /* the last has no end */
  assert_int_equal(text_line(&line, &room, file), -1);
  free(line);
  fclose(file);
}

static void test_nan_has_no_sign(void **unused)
{
  (void)unused;
  char text[64];
  snprintf(text, sizeof text, "%g %g %g %g", text_real(-NAN), text_real(NAN), text_real(-INFINITY), text_real(-0.0));
  assert_string_equal(text, "nan nan -inf -0");
}

/* From the first that is not 0 to the last. */
static int digits_of(const char *text)
{
  int digits = 0, zeros = 0;
  for (const char *c = text; *c && *c != 'e'; c++)
    if (*c == '0' && digits > 0)
      zeros++;
    else if (*c >= '1' && *c <= '9')
      digits += 1 + zeros, zeros = 0;
  return digits;
}

/* Bits at random, and numbers of few digits: what is written reads back, and fewer digits do not. */
static void test_shortest_that_reads_back(void **unused)
{
  (void)unused;
  char text[TEXT_REAL_SIZE], shorter[400];
  static const struct {
    double x;
    const char *text;
  } known[] = {{0.8, "0.8"},
               {0.1 + 0.2, "0.30000000000000004"},
               {1.0 / 3.0, "0.3333333333333333"},
               {-0.0, "-0"},
               {1e300, "1e+300"},
               {-NAN, "nan"},
               {INFINITY, "inf"},
               {9007199254740993.0, "9007199254740992"}};
  for (size_t k = 0; k < sizeof known / sizeof *known; k++) {
    text_shortest(known[k].x, text);
    assert_string_equal(text, known[k].text);
  }
  uint64_t bits = 88172645463325252u;
  for (int k = 0; k < 20000; k++) {
    double x;
    bits ^= bits << 13, bits ^= bits >> 7, bits ^= bits << 17; /* Marsaglia 2003 */
    memcpy(&x, &bits, sizeof x);
    if (!isnormal(x))
      continue;
    text_shortest(x, text);
    assert_true(strtod(text, NULL) == x);
    for (int digits = 1; digits <= 17; digits++) {
      snprintf(shorter, sizeof shorter, "%.*g", digits, x);
      assert_true(strtod(shorter, NULL) != x || digits_of(text) <= digits_of(shorter));
    }
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_what_acts_is_escaped),
                                     cmocka_unit_test(test_nothing_acts),
                                     cmocka_unit_test(test_it_is_cut_between_characters),
                                     cmocka_unit_test(test_messages),
                                     cmocka_unit_test(test_words_for_a_shell),
                                     cmocka_unit_test(test_lines_have_a_bound),
                                     cmocka_unit_test(test_nan_has_no_sign),
                                     cmocka_unit_test(test_shortest_that_reads_back)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
