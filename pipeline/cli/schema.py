"""JSON schema of the YAML of a case, for completion and checks in editors."""

from pipeline.contract.case import SOLVERS
from pipeline.contract.settings import ORIGINS

_DRAFT = "https://json-schema.org/draft/2020-12/schema"


def case_schema(chains):
    """Schema of a case of one of ``chains`` (name -> stages)."""
    chain_schemas = [_chain_schema(name, stages) for name, stages in chains.items()]
    body = chain_schemas[0] if len(chain_schemas) == 1 else {"anyOf": chain_schemas}
    distinct = {stage.name: stage for stages in chains.values() for stage in stages}
    definitions = {key: value for stage in distinct.values() for key, value in _definitions(stage).items()}
    return {"$schema": _DRAFT, "title": "brakechain case", **body, "$defs": definitions}


def _chain_schema(name, stages):
    sections = {stage.name: {"$ref": f"#/$defs/{stage.name}"} for stage in stages}
    head = {"chain": {"const": name}, "title": {"type": "string"}, "description": {"type": "string"},
            "based_on": {"type": "string", "description": "another case, whose values apply where this one gives none"},
            "solver": {"enum": list(SOLVERS), "default": "auto"}}
    named = [{"required": ["chain"]}, {"required": ["based_on"]}]
    return {"type": "object", "properties": {**head, **sections}, "anyOf": named, "additionalProperties": False}


def _definitions(stage):
    """{name: schema} of the section of ``stage`` and of the sections in it, as they stand under $defs."""
    section = stage.settings.model_json_schema(ref_template=f"#/$defs/{stage.name}.{{model}}")
    inner = {f"{stage.name}.{key}": _annotated(value) for key, value in section.pop("$defs", {}).items()}
    return {**inner, stage.name: {**_annotated(section), "title": stage.name, "description": stage.summary}}


def _annotated(section):
    """``section`` where every value may also be written with its origin."""
    if "properties" not in section:
        return section
    section = {key: value for key, value in section.items() if key != "required"}    # a base case may give the rest
    return {**section, "properties": {key: _with_origin(value) for key, value in section["properties"].items()}}


def _with_origin(schema):
    notes = {k: v for k, v in schema.items() if k in ("description", "title", "default")}
    bare = {k: v for k, v in schema.items() if k not in notes}
    inner = bare.get("additionalProperties")
    if isinstance(inner, dict) and "$ref" not in inner:     # values by name: each may have its origin
        bare["additionalProperties"] = _with_origin(inner)
    origin = {"type": "object", "additionalProperties": False, "required": ["value"],
              "properties": {"value": bare, "origin": {"enum": list(ORIGINS)}, "source": {"type": "string"},
                             "doubt": {"type": "string"}, "choose": {"type": "string"}}}
    return {**notes, "anyOf": [bare, origin]}
