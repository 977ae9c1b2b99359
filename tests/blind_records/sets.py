"""Blind sets: records of a machine of plants.py with an effect of a wanted size inside, and the files of the model that is declared without it."""

import numpy as np

from kinds import RECORDS, KINDS
import plants

SEARCHES = 7


class Batch:
    """Cases of one kind: (effect or None, size, seed), all simulated side by side."""

    def __init__(self, kind_name, cases):
        self.name = kind_name
        self.kind = KINDS[kind_name]
        self.cases = cases
        n = len(cases)
        self.truth = {name: np.full(n, value) for name, value in self.kind.truth.items()}
        self.declared = {name: np.full(n, value) for name, value in self.kind.truth.items()}
        for c, (_, _, seed) in enumerate(cases):
            rng = np.random.default_rng([seed, 1])  # the same machine for every effect and size
            for number in self.kind.free.values():
                self.declared[number][c] = float(f"{self.kind.truth[number] * (1.0 + rng.uniform(-0.1, 0.1)):.9g}")
        self.amount = np.zeros(n)
        self._search()

    def _numbers(self, amount, factors):
        """Numbers of the plant and of its sensors with the effects in."""
        numbers = {name: values.copy() for name, values in self.truth.items()}
        for number, factor in (factors or {}).items():
            numbers[number] = numbers[number] * factor
        sensors = {column: {"gain": np.ones(len(self.cases)), **{what: np.zeros(len(self.cases)) for what in ("bias", "drift", "delay", "lag")}}
                   for column in self.kind.sigma}
        for c, (effect, _, _) in enumerate(self.cases):
            if effect is None:
                continue
            if ":" in effect.number:
                column, what = effect.number.split(":")
                for of in self.kind.sigma if column == "*" else [column]:
                    sensors[of][what][c] += amount[c]
            elif effect.share:
                numbers[effect.number][c] *= 1.0 + amount[c]
            else:
                numbers[effect.number][c] += amount[c]
        return numbers, sensors

    def readings(self, amount, record, factors=None):
        """Times, and by column (readings, cases) without noise; factors: of the numbers that are fitted."""
        numbers, sensors = self._numbers(amount, factors)
        fine, step = self.kind.plant(numbers, record)
        told = {}
        for column in self.kind.sigma:
            times, told[column] = plants.read_off(fine[column], step, self.kind.interval, sensors[column])
        return times, told

    def _stacked(self, told):
        return np.concatenate([told[column] / sigma for column, sigma in self.kind.sigma.items()])

    def _search(self):
        """Amounts at which what is left of the effect's change, the fitted numbers fitted to it, has the wanted norm in units of the noise: amounts
        and fits of all cases by turns, with the derivatives of the machine without effects."""
        first = RECORDS[0]
        n = len(self.cases)
        nothing = np.zeros(n)
        base = self._stacked(self.readings(nothing, first)[1])
        small = 1e-4
        columns = [(self._stacked(self.readings(nothing, first, {number: 1.0 + small})[1]) - base) / small for number in self.kind.free.values()]
        inside = np.array([effect is not None for effect, _, _ in self.cases])
        self.made = np.zeros(n)
        wanted = np.array([size for _, size, _ in self.cases], dtype=float)
        amount = np.array([effect.guess if effect else 0.0 for effect, _, _ in self.cases])
        factors = {number: np.ones(n) for number in self.kind.free.values()}
        for _ in range(SEARCHES if inside.any() else 0):
            self.amount = amount.copy()
            change = self._stacked(self.readings(amount, first)[1]) - self._stacked(self.readings(nothing, first, factors)[1])
            for c in np.nonzero(inside)[0]:
                j = np.stack([column[:, c] for column in columns], axis=1)
                step = np.linalg.lstsq(j, change[:, c], rcond=None)[0]
                self.made[c] = np.linalg.norm(change[:, c] - j @ step)
                # The next amount takes the fit along, as both are nearly in proportion.
                grow = np.clip(wanted[c] / max(self.made[c], 1e-9), 0.1, 10.0)
                amount[c] *= grow
                for k, number in enumerate(self.kind.free.values()):
                    factors[number][c] = 1.0 + grow * (factors[number][c] + step[k] - 1.0)

    def write(self, c, folder, readings):
        """The files of one case; readings: by record, as `readings` gives them, with this case's amount."""
        effect, size, seed = self.cases[c]
        rng = np.random.default_rng([seed, 2, int(size), *self.name.encode(), *(effect.label.encode() if effect else b"none")])
        for name, text in self.kind.files({k: float(v[c]) for k, v in self.declared.items()}).items():
            (folder / name).write_text(text)
        record_tables = ""
        for record in RECORDS:
            times, told = readings[record]
            noisy = {column: told[column][:, c] + rng.normal(0.0, sigma, len(times)) for column, sigma in self.kind.sigma.items()}
            with (folder / f"{record}.csv").open("w") as out:
                out.write("time_s," + ",".join(noisy) + "\n")
                for i, t in enumerate(times):
                    out.write(f"{t:.6f}," + ",".join(f"{values[i]:.9g}" for values in noisy.values()) + "\n")
            columns = ", ".join(f'{column} = "{column}"' for column in noisy)
            sigmas = ", ".join(f"{column} = {sigma}" for column, sigma in self.kind.sigma.items())
            record_tables += f'[[records]]\nname = "{record}"\nfile = "{record}.csv"\ncolumns = {{ {columns} }}\nsigma = {{ {sigmas} }}\n'
            if record in self.kind.set:
                record_tables += "set = { " + ", ".join(f'"{k}" = {_toml(v)}' for k, v in self.kind.set[record].items()) + " }\n"
        free = ", ".join(f'"{key}"' for key in self.kind.free)
        (folder / "record.toml").write_text('schema = "snare-record/1"\ntitle = "blind"\nscenario = "scenario.toml"\n' + record_tables +
                                            f'[fit]\nfree = [{free}]\nheldout = ["second"]\n')


def _toml(value):
    return f'"{value}"' if isinstance(value, str) else str(value)
