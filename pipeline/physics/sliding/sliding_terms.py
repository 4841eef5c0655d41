"""Terms of small motions about steady sliding: the one place where equations (1) to (3) of the sliding model stand."""

from pipeline.physics.system.forms import Block, Rows
from pipeline.physics.system.terms import Kind, Owner, Term, What


def supporting_terms(model, gyroscopic=True, centrifugal=True) -> tuple[Term, ...]:
    """Of the bodies and joints of a SlidingModel."""
    joints = model.joints
    terms = [
        Term.sliding(What.MASS, Kind.MASS, Block(model.mass), Owner.BODY),
        Term.sliding(What.STRUCTURAL_DAMPING, Kind.DAMPING, Block(model.damping), Owner.BODY),
        Term.sliding(What.STRUCTURAL_DAMPING, Kind.DAMPING, Rows(joints.rows, joints.damping, joints.rows),
                     Owner.JOINT),
        Term.sliding(What.STRUCTURAL_STIFFNESS, Kind.STIFFNESS, Block(model.stiffness), Owner.BODY),
        Term.sliding(What.STRUCTURAL_STIFFNESS, Kind.STIFFNESS, Rows(joints.rows, joints.stiffness, joints.rows),
                     Owner.JOINT)]
    if gyroscopic:
        terms.append(Term.sliding(What.GYROSCOPIC, Kind.DAMPING, Block(model.gyroscopic, model.speed), Owner.BODY))
    if centrifugal:
        terms.append(Term.sliding(What.CENTRIFUGAL, Kind.STIFFNESS, Block(model.centrifugal, model.speed**2),
                                  Owner.BODY))
    return tuple(terms)


def pressing_terms(model) -> tuple[Term, ...]:
    """Of the closed contacts along their normals, equation (1)."""
    contacts = model.contacts
    return (Term.sliding(What.CONTACT_DAMPING, Kind.DAMPING,
                         Rows(contacts.normal, contacts.damping, contacts.normal), Owner.CONTACT),
            Term.sliding(What.CONTACT_STIFFNESS, Kind.STIFFNESS,
                         Rows(contacts.normal, contacts.stiffness, contacts.normal), Owner.CONTACT))


def friction_terms(model, state, friction_damping=True) -> tuple[Term, ...]:
    """Of the friction of a FrictionState, equation (2) and, if wanted, (3)."""
    contacts, coupling = model.contacts, model.coupling(state)
    terms = [
        Term.sliding(What.FRICTION_DAMPING, Kind.DAMPING,
                     Rows(contacts.tangent, coupling * contacts.damping, contacts.normal), Owner.CONTACT),
        Term.sliding(What.FRICTION_OVER_SLIP, Kind.DAMPING,
                     Rows(contacts.tangent, contacts.preload * state.speed_slope, contacts.tangent), Owner.CONTACT),
        Term.sliding(What.CIRCULATORY, Kind.STIFFNESS,
                     Rows(contacts.tangent, coupling * contacts.stiffness, contacts.normal), Owner.CONTACT)]
    if friction_damping:
        drag = model.turning_drag(state.coefficient)
        terms.append(Term.sliding(What.FRICTION_TURNING, Kind.DAMPING,
                                  Rows(contacts.lateral, drag, contacts.lateral), Owner.CONTACT))
    return tuple(terms)
