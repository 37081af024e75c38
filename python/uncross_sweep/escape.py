"""Foreign text for terminals and shells: the one home of this in Python, as src/base/text.h is in C."""
import re

# Characters that act on a terminal instead of being shown: as text_acts of src/base/text.c. Surrogates stand for bytes
# that are no UTF-8.
_ACTS = re.compile("[\x00-\x1f\x7f-\x9f\u200e\u200f\u2028-\u202e\u2066-\u2069\ufeff\ud800-\udfff]")


def _bytes_of(character):
    return "".join(f"\\x{byte:02x}" for byte in character.encode(errors="surrogateescape" if "\udc80" <= character <= "\udcff"
                                                                 else "surrogatepass"))


def shown(text):
    """What a terminal only shows, on one line: also fit for a comment of a script."""
    return _ACTS.sub(lambda m: {"\n": "\\n", "\t": "\\t"}.get(m[0]) or _bytes_of(m[0]), str(text))


def word(text):
    """A word as bash takes it, which a terminal only shows. Another shell may take it for another word, but never for more than
    one: there is no \\' in it, which ends a word where $ before a quote is not known."""
    if re.fullmatch(r"[A-Za-z0-9_./=:,+-]+", text):
        return text
    if not _ACTS.search(text):
        return "'" + text.replace("'", "'\\''") + "'"
    quoted = text.replace("\\", "\\\\").replace("'", "\\x27")
    return "$'" + _ACTS.sub(lambda m: _bytes_of(m[0]), quoted) + "'"


def words(texts):
    return " ".join(word(text) for text in texts)


def path(name):
    """A path that no command takes for an option."""
    return f"./{name}" if str(name).startswith("-") else str(name)
