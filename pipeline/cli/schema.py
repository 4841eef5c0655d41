"""JSON schema of the YAML of a case, for completion and checks in editors."""

from pipeline.contract.case import SOLVERS
from pipeline.contract.settings import ORIGINS

_DRAFT = "https://json-schema.org/draft/2020-12/schema"


def case_schema(chains):
    """Schema of a case of one of ``chains`` (name -> stages)."""
    found = [_chain_schema(name, stages) for name, stages in chains.items()]
    definitions = {k: v for schema in found for k, v in schema.pop("$defs").items()}
    body = found[0] if len(found) == 1 else {"anyOf": found}
    return {"$schema": _DRAFT, "title": "brakechain case", **body, "$defs": definitions}


def _chain_schema(name, stages):
    sections, definitions = {}, {}
    for stage in stages:
        section = stage.settings.model_json_schema(ref_template=f"#/$defs/{stage.name}.{{model}}")
        inner = section.pop("$defs", {})
        definitions.update({f"{stage.name}.{key}": _annotated(value) for key, value in inner.items()})
        sections[stage.name] = {**_annotated(section), "title": stage.name, "description": stage.summary}
    head = {"chain": {"const": name}, "title": {"type": "string"}, "description": {"type": "string"},
            "based_on": {"type": "string", "description": "another case, whose values hold where this one is silent"},
            "solver": {"enum": list(SOLVERS), "default": "auto"}}
    named = [{"required": ["chain"]}, {"required": ["based_on"]}]
    return {"type": "object", "properties": {**head, **sections}, "anyOf": named, "additionalProperties": False,
            "$defs": definitions}


def _annotated(section):
    """``section`` where every value may also be written with its origin."""
    if "properties" not in section:
        return section
    section = {key: value for key, value in section.items() if key != "required"}    # a base case may hold the rest
    return {**section, "properties": {key: _with_origin(value) for key, value in section["properties"].items()}}


def _with_origin(schema):
    told = {k: v for k, v in schema.items() if k in ("description", "title", "default")}
    bare = {k: v for k, v in schema.items() if k not in told}
    inner = bare.get("additionalProperties")
    if isinstance(inner, dict) and "$ref" not in inner:     # values by name: each may have an origin of its own
        bare["additionalProperties"] = _with_origin(inner)
    origin = {"type": "object", "additionalProperties": False, "required": ["value"],
              "properties": {"value": bare, "origin": {"enum": list(ORIGINS)}, "source": {"type": "string"},
                             "doubt": {"type": "string"}, "choose": {"type": "string"}}}
    return {**told, "anyOf": [bare, origin]}
