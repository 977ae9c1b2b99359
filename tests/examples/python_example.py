#!/usr/bin/env python3
"""example_output.py for a program in Python: skipped, with status 77, where the module was not built."""

import sys

import example_output

if __name__ == "__main__":
    try:
        import snare  # noqa: F401
    except ImportError as reason:
        print(f"skipped: the Python module was not built ({reason}); ./test builds it")
        sys.exit(77)
    sys.argv.insert(1, sys.executable)
    sys.exit(example_output.main())
