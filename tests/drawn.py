"""Property tests: how many examples, and the same ones in every run."""

from hypothesis import HealthCheck, settings

#: an example may take as long as it takes on a busy machine; folders of a test are used again by each of its examples
FEW = settings(max_examples=25, deadline=None, derandomize=True, database=None,
               suppress_health_check=[HealthCheck.function_scoped_fixture, HealthCheck.too_slow])
MANY = settings(FEW, max_examples=300)
