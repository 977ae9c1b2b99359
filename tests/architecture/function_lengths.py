#!/usr/bin/env python3
"""Functions of the product fit on a screen: at most 80 lines of body.

usage: function_lengths.py REPOSITORY

KERNELS are longer: every term of an element's stiffness stands once, and its parts share what is held in registers.
"""

import pathlib
import sys

MOST = 80
KERNELS = {"wire/motion/rod_stiffness.cpp", "wire/spatial_assembly.cpp"}


def main():
    root = pathlib.Path(sys.argv[1]).resolve()
    sys.path.insert(0, str(root / "scripts"))
    import count_lines

    long = []
    for name in count_lines.sources(root):
        if name.parts[0] in count_lines.BESIDE or str(name) in KERNELS:
            continue
        for function, count, line in count_lines.functions((root / name).read_text(encoding="utf-8")):
            if count > MOST:
                long.append(f"{name}:{line}: {function} has {count} lines, at most {MOST}")
    print("\n".join(long) or f"no function has more than {MOST} lines")
    return 1 if long else 0


if __name__ == "__main__":
    sys.exit(main())
