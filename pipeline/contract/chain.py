"""The chain that follows from the sections of a case: their stages, those that these cannot do without, and the report.

A stage needs what its signature reads. Where only one stage writes that, it joins by its defaults; where several could,
the case says which by a section of its own.
"""

from pipeline.contract.errors import ConfigError

#: as a case may name its chain, beside leaving it out
SECTIONS = "sections"
#: the stage that ends every chain
_LAST = "report"


def from_sections(sections, stages, where):
    """Names of the stages that the ``sections`` (names) of a case ask for, in an order in which each follows what it
    reads.

    ``stages`` {name: Stage} in reading order, which decides between stages that do not depend on each other; ``where``
    is said in errors. ConfigError without a section, and where one of several stages must be named.
    """
    wanted = [name for name in stages if name in sections]
    if not wanted:
        raise ConfigError(f"{where}: chain", "a chain, or sections of stages from which it follows", "neither",
                          "state one: 'brakechain schema' lists both")
    for name in wanted:     # which grows meanwhile
        for products in _required(stages[name]):
            writers = [other for other, stage in stages.items() if stage.output.name in products]
            if not set(writers) & set(wanted):
                if len(writers) != 1:
                    raise ConfigError(f"{where}: {name}", f"a section for what it reads: {' or '.join(writers)}",
                                      "none", "state the one that describes the system, or name a chain")
                wanted.append(writers[0])
    return _ordered({name: stages[name] for name in stages if name in {*wanted, _LAST}})


def _required(stage):
    """[{names of products}] of the arguments that a Stage cannot do without."""
    return [{product.name for product in products} for argument, products in stage.inputs.items()
            if argument not in stage.optional]


def _ordered(stages):
    """Names of ``stages`` {name: Stage}, each after all that write what it reads, else in their order."""
    left, found = dict(stages), []
    while left:
        missing = {stage.output.name for stage in left.values()}
        free = [name for name, stage in left.items() if not _read(stage) & (missing - {stage.output.name})]
        free = [name for name in free if not left[name].reads_all] or free
        found.append(free[0])
        del left[free[0]]
    return tuple(found)


def _read(stage):
    """Names of all products that a Stage may read."""
    return {product.name for products in stage.inputs.values() for product in products}
