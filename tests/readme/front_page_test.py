#!/usr/bin/env python3
"""The checks of the front page."""

import unittest

from front_page import loose_numbers, words


class FrontPage(unittest.TestCase):
    def test_code_blocks_have_no_words(self):
        self.assertEqual(words("one two\n```sh\n./run a b c\n```\nthree\n"), 3)

    def test_numbers_stand_in_regions_code_or_names(self):
        text = ("On Debian 12, `x = 3`, see [4](5.md).\n```toml\ny = 6\n```\n"
                "<!-- numbers: some -->\n| 7 |\n<!-- end of numbers -->\n")
        self.assertEqual(loose_numbers(text), ["4"])
        self.assertEqual(loose_numbers("The error is 0.3 % of 12 N."), ["0.3", "12"])


if __name__ == "__main__":
    unittest.main()
