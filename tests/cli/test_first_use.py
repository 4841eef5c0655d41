"""What the first run would compile is compiled by a brake that every check lets pass, as far as limit cycles."""

from click.testing import CliRunner

from pipeline.cli.main import cli
from pipeline.contract import runner


def test_a_smallest_brake_is_computed_up_to_its_limit_cycle(monkeypatch):
    asked = []

    def execute(run, context, last):
        asked.append((last, [state.stage.name for state in run.plan(last=last)], context.solver == run.solver))

    monkeypatch.setattr(runner.ChainRun, "execute", execute)
    done = CliRunner().invoke(cli, ["compile"], catch_exceptions=False)
    assert done.exit_code == 0 and "compiled" in done.output
    (last, stages, same), = asked
    assert last == stages[-1] == "limit_cycle" and {"structure", "complex_modes"} <= set(stages) and same
