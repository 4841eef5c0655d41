"""The table of a product DesignSearch as CSV: every brake that was tried, in the order of the search."""

import csv
import io


def csv_table(product):
    """Text of the CSV file: a row of each brake in the order in which they were computed."""
    stream = io.StringIO()
    writer = csv.writer(stream, lineterminator="\n")
    writer.writerow(("brake", "start", "round", "role", *map(str, product.parameter), "unstable modes",
                     f"{product.kind} / 1/s", "cost / 1/s", "objective / 1/s", "best"))
    for k, name in enumerate(product.brake):
        writer.writerow((name, product.start[k], product.round[k], product.role[k], *map(str, product.written[k]),
                         product.unstable[k], *(f"{each[k]:.6g}" for each in
                                                (product.growth, product.cost, product.objective)),
                         "best" if k == product.best else ""))
    return stream.getvalue()
