"""Run a chain in a run folder: stages that are up to date are skipped, the others computed and published atomically."""

import errno
import json
import os
import platform
import time
from contextlib import suppress
from dataclasses import asdict, dataclass, field, replace
from functools import partial
from pathlib import Path

from pipeline import __version__
from pipeline.contract import fingerprint, further, store
from pipeline.contract.context import Context
from pipeline.contract.errors import BrakechainError, ConfigError, ProductError
from pipeline.contract.executors.cpu_time import cpu_seconds
from pipeline.contract.executors.long_tasks import LongTasks
from pipeline.contract.executors.unfinished import Unfinished
from pipeline.contract.integrity import checksum, examined, seen
from pipeline.contract.integrity.kept import Kept
from pipeline.contract.integrity.lock import closed, locked
from pipeline.contract.integrity.origin import git_commit, kernels, packages
from pipeline.contract.integrity.verify import of_companions, recorded
from pipeline.contract.received import names
from pipeline.contract.stage import Products, Sections


@dataclass(frozen=True)
class State:
    """State of one stage in a run folder."""

    stage: object
    reasons: tuple      # why it must run; empty if up to date
    path: Path
    variant: str = ""   # of the case, for which the stage runs


@dataclass(frozen=True)
class ChainRun:
    """One case in one folder."""

    case: object        # case.CaseFile
    folder: Path
    solver: str         # resolved, joins every hash
    variant: str = ""   # name of the variant of another run that this is
    shared: dict = field(default_factory=dict)      # product name -> its path, where another run holds the same
    code: dict = None       # stage -> digests of its code when this run began; None = those of now
    runs: dict = field(default_factory=dict, init=False, repr=False, compare=False)     # of its variants, once made

    def __post_init__(self):
        if self.code is None:
            code = {stage.name: fingerprint.code_of(stage.run.__module__) for stage in self.case.stages}
            object.__setattr__(self, "code", code)

    def path(self, product):
        return self.shared.get(product.name, self.folder / f"{product.name}.h5")

    def producer(self, products):
        """The stage of this chain that writes one of ``products``, or None."""
        names = {p.name for p in products}
        return next((s for s in self.case.stages if s.output.name in names), None)

    def filled(self, stage):
        """argument -> product class that fills it in this chain (None for an absent optional one).

        The arguments of a stage that reads all products are the names of all previous ones.
        """
        if stage.reads_all:
            previous = self.case.stages[:self.case.stages.index(stage)]
            return {s.output.name: s.output for s in previous}
        chosen = {}
        for name, products in stage.inputs.items():
            writer = self.producer(products)
            if writer is None and name not in stage.optional:
                raise ConfigError(f"{stage.name}.{name}", f"a stage before it that writes {products[0].name}", "none")
            chosen[name] = writer.output if writer else None
        return chosen

    def variants(self, stage, ready=None):
        """(name, run of the variant, its last stage, argument) for each variant that ``stage`` takes products from.

        Of a stage that searches, those that it asks for by what came of the variants in ``ready``; None = of all whose
        products are there. Products that no stage of the chain makes are left out.
        """
        made = further.asked(self, stage, ready)
        return [(name, self.varied(name, changes), last, argument) for argument, product in stage.varied.items()
                if (last := self.producer((product,))) for name, changes in made.items()]

    def varied(self, name, changes):
        """The run of a variant, which shares what its changes leave as it is."""
        key = name, json.dumps(changes, default=str)
        if key not in self.runs:
            self.runs[key] = self._varied(name, changes)
        return self.runs[key]

    def _varied(self, name, changes):
        changed, shared = {key.partition(".")[0] for key in changes}, {}
        for stage in self.case.stages:
            parts = [p.name for p in self.filled(stage).values() if p] if not stage.reads_all else [""]
            if stage.name not in changed and all(part in shared for part in parts):
                shared[stage.output.name] = self.path(stage.output)
        names.within(self.folder, f"variants/{names.checked(name, 'a variant')}")
        folder = self.folder / "variants" / name
        return ChainRun(self.case.varied(changes), folder, self.solver, name, shared, self.code)

    def _ingredients(self, stage):
        """(key, product, path) of everything that ``stage`` reads."""
        found = [(name, product, self.path(product)) for name, product in self.filled(stage).items() if product]
        return found + [(f"{argument} of {name}", last.output, run.path(last.output))
                        for name, run, last, argument in self.variants(stage)]

    def fingerprint(self, stage):
        """What the output of ``stage`` currently depends on; None while an input is missing."""
        inputs = {}
        for key, product, path in self._ingredients(stage):
            identity = store.identity(path)
            if identity is None or identity[:2] != (product.name, product.version):
                return None
            inputs[key] = [product.name, identity[2]]
        settings = fingerprint.settings_of(self.case.sections[stage.name])
        for name in stage.built_from:
            of_other = fingerprint.settings_of(self.case.sections[name])
            settings |= {f"{name}.{key}": value for key, value in of_other.items()}
        digest = self.case.digest if stage.reads_case else ""
        code = self.code[stage.name]
        return fingerprint.Fingerprint(stage.output.version, self.solver, settings, inputs, code, digest)

    def state(self, stage, stale=frozenset()):
        """State of ``stage``; ``stale`` names the products that would be computed before it."""
        path = self.path(stage.output)
        stored, current = _stored(path), self.fingerprint(stage)
        reasons = [] if current is None else fingerprint.reasons(stored and stored["fingerprint"], current)
        if stored is None:
            reasons = [_unreadable(path)]
        else:
            reasons += of_companions(self.folder, stored["companions"])
        renewed = [p.name for p in self.filled(stage).values() if p and p.name in stale]
        renewed += [f"{argument} of {name}" for name, run, last, argument in self.variants(stage)
                    if any(each.reasons for each in run.needed(last, stale))]
        reasons += [f"input {name} is computed anew" for name in renewed if f"input {name} changed" not in reasons]
        if current is None and not reasons:
            reasons = ["an input is missing"]
        return State(stage, tuple(reasons), path)

    def needed(self, last, stale=frozenset()):
        """States of the stages that this run of a variant computes for ``last``; ``stale`` as of ``state``."""
        stale, states = set(stale), []
        for stage in self._towards(last):
            states.append(self.state(stage, stale))
            stale.update({stage.output.name} if states[-1].reasons else ())
        return states

    def _towards(self, last):
        """The stages whose products ``last`` depends on, and itself, less those whose product another run holds."""
        wanted, found = {last.output.name}, []
        for stage in reversed(self.case.stages):
            if stage.output.name in wanted and stage.output.name not in self.shared:
                found.insert(0, stage)
                wanted.update(p.name for p in self.filled(stage).values() if p)
        return found

    def plan(self, first=None, last=None, force=frozenset()):
        """States of the stages from ``first`` to ``last`` in a run that starts now."""
        self._examine()
        stale, states = set(), []
        for stage in self._span(first, last):
            state = self._forced(self.state(stage, stale), force)
            stale.update({stage.output.name} if state.reasons else ())
            states.append(state)
        return states

    def stale_before(self, first):
        """States of the stages before ``first`` whose products exist but are out of date."""
        skipped = len(self.case.stages) - len(self._span(first, None))
        states = self.plan()[:skipped] if skipped else []
        return [state for state in states if state.reasons and state.path.exists()]

    def _span(self, first, last):
        names = [s.name for s in self.case.stages]
        for option, name in (("--from", first), ("--until", last)):
            if name is not None and name not in names:
                raise ConfigError(option, f"one of {', '.join(names)}", repr(name))
        begin = names.index(first) if first else 0
        end = names.index(last) + 1 if last else len(names)
        if begin >= end:
            raise ConfigError("--from/--until", "a stage at or after --from", f"--from {first} --until {last}")
        return self.case.stages[begin:end]

    def execute(self, context, first=None, last=None, force=frozenset(), report=lambda state, seconds: None,
                opening=lambda: None, unfinished=None):
        """Compute what must be computed; ``report`` is called with (state, seconds or None) after each stage.

        ``opening`` is called once the folder is locked, before all stages; ``unfinished``: Unfinished, which learns
        what fails. Returns the number of stages computed; raises the first error of a stage, after all that goes on.
        """
        planned = [] if os.access(self.folder, os.W_OK) else self.plan(first, last, force)
        if planned and not any(state.reasons for state in planned):     # nothing to write: it may be read-only
            for state in planned:
                report(state, None)
            return 0
        with locked(self.folder):
            new = self._examine()
            try:
                opening()
                return self._bring_all(self._span(first, last), context, force, report, unfinished or Unfinished())
            finally:
                self._note()
                if new:
                    self._note_variants()

    def ready_to_look(self, name, changes, last, context):
        """(Run of a variant that no stage reads, task (function, item) that computes it up to ``last``); what it shares
        is computed."""
        run = self.varied(name, changes)
        read = {product for stage in run._towards(last) for product in run.filled(stage).values() if product}
        for product in sorted(read, key=lambda each: each.name):
            if product.name in run.shared:
                for stage in self._towards(self.producer((product,))):
                    self._bring(stage, context, frozenset(), lambda state, seconds: None)
        self._note()
        return run, (_computed, (run, [last]))

    def announce(self, stage, name, content):
        """Write ``content`` where ``stage`` will write its companion ``name``, in place of what it wrote before."""
        stored = _stored(self.path(stage.output))
        for old in (self.path(stage.output), *(self.folder / each for each in (stored or {}).get("companions", ()))):
            _remove(old)
        store.write_companion(self.folder / name, content)

    def _examine(self):
        """Have all products that are not known examined by one process; their number."""
        files = (*self.folder.glob("*.h5"), *self.folder.glob("variants/*/*.h5"))
        return examined.examine([path for path in files if not seen.flaw(path)])

    def _note_variants(self):
        """The same as ``_note`` of all variants."""
        for run in {name: run for stage in self.case.stages for name, run, *_ in self.variants(stage)}.values():
            run._note()

    def _note(self):
        """List what is as it was written: it is not hashed again before it changes."""
        right = {}
        for stage in self.case.stages:
            path = self.path(stage.output)
            stored = path.parent == self.folder and _stored(path)
            if stored:
                right |= {path.name: ""} | {name: digest for name, digest in stored["companions"].items()
                                            if not seen.differs(self.folder / name, digest)}
        seen.note(self.folder, right)

    def _bring_all(self, stages, context, force, report, unfinished):
        """Bring the products of ``stages`` up to date, long tasks beside what does not need them; number computed."""
        tasks, computed = LongTasks(self, context, report, unfinished), 0
        try:
            for stage in stages:
                computed += tasks.gather(stage)
                if unfinished.needed_by(stage, self.filled(stage).values()):
                    continue
                with unfinished.noted(stage):
                    if not (stage.alone and context.spares and tasks.begin(self._forced(self.state(stage), force))):
                        computed += self._bring(stage, context, force, report)
        except BrakechainError:     # what is under way is kept, as if it had come first
            with suppress(BrakechainError):
                tasks.gather()
            raise
        computed += tasks.gather()
        unfinished.end()
        return computed

    def _bring(self, stage, context, force, report):
        """Bring the product of ``stage`` up to date, those of variants that it reads first; number computed."""
        varied = [report(*done) for done in self._bring_variants(stage, context)]       # each as it is computed
        state = self._forced(self.state(stage), force)
        report(replace(state, variant=self.variant), self._compute(stage, context) if state.reasons else None)
        return len(varied) + bool(state.reasons)

    @staticmethod
    def _forced(state, force):
        return replace(state, reasons=("forced", *state.reasons)) if state.stage.name in force else state

    def _bring_variants(self, stage, context):
        """(state, seconds) of all that was computed to bring products of variants up to date that ``stage`` reads.

        Variants run side by side, each in one process, where that process writes to the run folder; else in turn. What
        a search asks for by their products follows, until it asks for nothing more.
        """
        ready = set()
        while new := [each for each in self.variants(stage, ready) if each[0] not in ready]:
            yield from self._bring_round(stage, new, context)
            ready.update(name for name, *_ in new)

    def _bring_round(self, stage, new, context):
        """As of ``_bring_variants``, of some variants."""
        lasts = {}
        for name, run, last, _ in new:
            if any(state.reasons for state in run.needed(last)):
                lasts.setdefault(name, (run, []))[1].append(last)
        old = list(lasts.values())
        if not old:
            return []
        if not context.sees_files:
            return [done for task in old for done in _computed(task, context)]
        self._note()        # processes that read what this one wrote know it by the list
        with context.stage(stage):
            return [done for variant in context.map(_computed, old, "variants of the case") for done in variant]

    def arguments(self, stage, context):
        """({argument: product, settings or sections}, Fingerprint) of ``stage`` that is computed now."""
        if not os.access(self.folder, os.W_OK | os.X_OK):      # at once, not after minutes of computing
            raise closed(self.folder, os.strerror(errno.EACCES))
        inputs, current = self._inputs(stage, not context.sees_files), self.fingerprint(stage)
        for _, product, path in self._ingredients(stage):   # also those that a stage which reads all might never read
            if current is None and store.identity(path) is None:
                store.read(product, path)       # says what is wrong with it
        return inputs | {"settings": self.case.sections[stage.name]}, current

    def _compute(self, stage, context):
        arguments, current = self.arguments(stage, context)
        kept = Kept.of(self.folder / f".{stage.name}.kept", asdict(current), packages())
        context = replace(context, kept=kept if context.sees_files else None)
        wall, cpu = time.perf_counter(), cpu_seconds() + context.spent_elsewhere()
        with context.stage(stage):
            output = stage(**arguments, context=context)
        seconds = time.perf_counter() - wall
        self.publish(stage, output, current, seconds, cpu_seconds() + context.spent_elsewhere() - cpu)
        kept.forget()
        return seconds

    def publish(self, stage, output, current, seconds, cpu):
        """Write the product of ``stage``, which took ``seconds`` by the clock and ``cpu``, and its companions."""
        if fingerprint.code_of(stage.run.__module__) != self.code[stage.name]:
            raise ProductError(f"stage {stage.name}", "the same code from start to end", "code that changed meanwhile",
                               "run again")
        companions = stage.companions(output, self.case.moved_to(self.folder)) if stage.companions else {}
        companions = {name: text.encode() if isinstance(text, str) else text for name, text in companions.items()}
        for name in companions:     # removed first: a product never lies beside companions of another one
            _remove(self.folder / names.checked(name, f"companions of {stage.name}"))
        store.write(output, self.path(stage.output), {
            "stage": stage.name, "brakechain": __version__, "git_commit": git_commit(),
            "settings": json.dumps(self.case.given(stage), default=str), "fingerprint": json.dumps(asdict(current)),
            "companions": json.dumps({name: checksum.digest_of(companions[name]) for name in sorted(companions)}),
            "packages": json.dumps(packages()),
            "kernels": json.dumps(kernels()), "python": platform.python_version(), "machine": platform.machine(),
            "wall_seconds": seconds, "cpu_seconds": cpu})
        for name, content in companions.items():
            store.write_companion(self.folder / name, content)

    def _inputs(self, stage, whole):
        """The arguments of ``stage`` that are products; read at once, or at their first use if it reads all.

        ``whole``: into memory, for tasks on other machines.
        """
        readers = {name: partial(store.read, product, self.path(product), whole) if product else lambda: None
                   for name, product in self.filled(stage).items()}
        if stage.reads_all:
            return {"products": Products(readers)}
        varied = {argument: {} for argument in stage.varied}
        for name, run, last, argument in self.variants(stage):
            varied[argument][name] = store.read(last.output, run.path(last.output), whole)
        given = {name: self.case.sections[name] for name in stage.built_from}
        sections = {"sections": Sections(given)} if given else {}
        return {name: read() for name, read in readers.items()} | varied | sections


def _computed(task, context=None):
    """(state, seconds) of each stage that was computed for some of a variant; ``task``: (ChainRun, [Stage])."""
    (run, lasts), done = task, []
    context = context or Context(solver=run.solver, case=run.case.card(__version__))
    with locked(run.folder):
        try:
            for each in {stage.name: stage for last in lasts for stage in run._towards(last)}.values():
                run._bring(each, context, frozenset(), lambda state, seconds: done.append((state, seconds)))
        except BrakechainError as error:
            raise type(error)(f"variant {run.variant}: {error.where}", error.expected, error.found,
                              error.remedy) from error
        run._note()
    return [(state, seconds) for state, seconds in done if seconds is not None]


def _stored(path):
    """Fingerprint and companions of the product at ``path``; None where there is no readable one."""
    if store.identity(path) is None:
        return None
    try:
        provenance = store.provenance(path)
        return {"fingerprint": json.loads(provenance["fingerprint"]), "companions": recorded(provenance)}
    except (ProductError, KeyError, ValueError, OSError, RuntimeError):
        return None


def _remove(path):
    try:
        path.unlink(missing_ok=True)
    except OSError as error:
        raise ProductError(path, "a file that can be replaced", error.strerror) from None


def _unreadable(path):
    return "its file is damaged" if path.is_symlink() or path.exists() else "not computed yet"
