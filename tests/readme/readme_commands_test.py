#!/usr/bin/env python3
"""The reader of README.md's blocks."""

import unittest

from readme_commands import commands, marked_blocks


class MarkedBlocks(unittest.TestCase):
    def test_only_marked_blocks_are_taken(self):
        text = "```sh\n./test\n```\n<!-- test: run -->\n```sh\n./run push a.toml\n```\n"
        self.assertEqual(list(marked_blocks(text)), [(6, None, "./run push a.toml\n")])

    def test_files_carry_their_name(self):
        text = "<!-- test: file my/a.toml -->\n```toml\nx = 1\n\ny = 2\n```\n"
        self.assertEqual(list(marked_blocks(text)), [(3, "my/a.toml", "x = 1\n\ny = 2\n")])

    def test_a_marker_without_a_block_is_an_error(self):
        with self.assertRaisesRegex(ValueError, "README.md:1: "):
            list(marked_blocks("<!-- test: run -->\n./run\n"))

    def test_an_open_block_is_an_error(self):
        with self.assertRaisesRegex(ValueError, "not closed"):
            list(marked_blocks("<!-- test: run -->\n```sh\n./run\n"))

    def test_comments_are_skipped_and_lines_joined(self):
        self.assertEqual(commands("# why\n./run push a.toml \\\n  --out b\n\n./run --version\n"),
                         ["./run push a.toml    --out b", "./run --version"])


if __name__ == "__main__":
    unittest.main()
