//! All mutants of a file in one text, each behind a question whether it is the active one.
//!
//! Operands are computed once, in the order of the source, and `&&` and `||` stay lazy:
//!
//! ```text
//! a + b    match (a, b) { (l, r) => match crate::mutant::at(7) { 7 => l - r, 8 => l * r, _ => l + r } }
//! a && b   { let l = a; if l != crate::mutant::on(9) { b } else { l } }
//! ```
//!
//! What must be known when the kernel is compiled cannot ask; mutants there are left out.

use crate::constant::{self, Constants};
use crate::edit::{Edited, Edits, Piece};
use crate::list::{Genre, Mutant, Place};
use proc_macro2::Span;
use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;
use syn::spanned::Spanned;
use syn::visit::{self, Visit};
use syn::{BinOp, Expr, Meta, Token, UnOp, punctuated::Punctuated};

/// A file of the kernel.
pub struct Source<'a> {
    /// The path from the repository.
    pub path: &'a str,
    pub text: &'a str,
    pub syntax: &'a syn::File,
}

/// The woven file.
pub struct Woven {
    pub edited: Edited,
    /// The mutants in it, and under which number each is recorded where it runs.
    pub marks: BTreeMap<u32, u32>,
    /// What cannot be written.
    pub refused: BTreeSet<u32>,
    /// In code that this machine does not compile.
    pub elsewhere: BTreeSet<u32>,
}

/// Weaves the mutants of one file, without those that are `dropped`.
pub fn weave(
    source: &Source<'_>,
    mutants: &[Mutant],
    dropped: &BTreeSet<u32>,
    constants: &Constants,
    machine: &BTreeSet<String>,
) -> Woven {
    let lines: Vec<usize> = std::iter::once(0)
        .chain(source.text.match_indices('\n').map(|(at, _)| at + 1))
        .chain([source.text.len()])
        .collect();
    let offset = |place: Place| {
        let line = &source.text[lines[place.line - 1]..lines[place.line]];
        let within = line.char_indices().map(|(at, _)| at).chain([line.len()]).nth(place.column - 1);
        lines[place.line - 1] + within.unwrap_or(line.len())
    };
    let mut here: BTreeMap<(Genre, usize), Vec<&Mutant>> = BTreeMap::new();
    for mutant in mutants.iter().filter(|mutant| mutant.file == source.path) {
        here.entry((mutant.genre, offset(mutant.span.start))).or_default().push(mutant);
    }
    let mut weaver = Weaver {
        source,
        here,
        dropped,
        constants,
        machine,
        edits: Edits::default(),
        marks: BTreeMap::new(),
        refused: BTreeSet::new(),
        elsewhere: BTreeSet::new(),
        of: None,
    };
    weaver.root();
    weaver.visit_file(source.syntax);
    let Weaver { edits, mut marks, refused, elsewhere, .. } = weaver;
    for id in edits.mutants() {
        marks.entry(id).or_insert(id);
    }
    Woven { marks, refused, elsewhere, edited: edits.apply(source.text) }
}

struct Weaver<'a> {
    source: &'a Source<'a>,
    here: BTreeMap<(Genre, usize), Vec<&'a Mutant>>,
    dropped: &'a BTreeSet<u32>,
    constants: &'a Constants,
    machine: &'a BTreeSet<String>,
    edits: Edits,
    marks: BTreeMap<u32, u32>,
    refused: BTreeSet<u32>,
    elsewhere: BTreeSet<u32>,
    /// The type whose `impl` this is.
    of: Option<String>,
}

fn bytes(spanned: &impl Spanned) -> Range<usize> {
    spanned.span().byte_range()
}

fn start(span: Span) -> usize {
    span.byte_range().start
}

fn text(text: impl Into<String>) -> Piece {
    Piece::Text(text.into())
}

/// Whether an expression is a chain of conditions with a `let` in it, where an `||` cannot stand.
fn has_let(expression: &Expr) -> bool {
    match expression {
        Expr::Let(_) => true,
        Expr::Binary(binary) => has_let(&binary.left) || has_let(&binary.right),
        _ => false,
    }
}

impl Weaver<'_> {
    /// The crate's root gets the module that knows which mutant is active.
    fn root(&mut self) {
        if !self.source.path.ends_with("/src/lib.rs") {
            return;
        }
        if let Some(first) = self.source.syntax.items.first() {
            let module = "extern crate std;\nmod mutant;\n";
            self.edits.insert(bytes(first).start, Vec::new(), vec![text(module)]);
        }
        for attribute in
            self.source.syntax.attrs.iter().filter(|attribute| attribute.path().is_ident("forbid"))
        {
            self.edits.replace(bytes(attribute), "");
        }
    }

    /// The mutants of a place that are to be woven.
    fn mutants(&self, genre: Genre, at: usize) -> Vec<(u32, String)> {
        let here = self.here.get(&(genre, at)).into_iter().flatten();
        here.filter(|mutant| !self.dropped.contains(&mutant.id))
            .map(|mutant| (mutant.id, mutant.replacement.clone()))
            .collect()
    }

    fn binary(&mut self, binary: &syn::ExprBinary) {
        let operator = bytes(&binary.op);
        let mutants = self.mutants(Genre::BinaryOperator, operator.start);
        let Some(&(first, _)) = mutants.first() else { return };
        let all = bytes(binary);
        let (left, right) = (all.start..operator.start, operator.end..all.end);
        let ids: Vec<u32> = mutants.iter().map(|(id, _)| *id).collect();
        let sign = self.source.text[operator].to_owned();
        let is_comparison = matches!(sign.as_str(), "==" | "!=" | "<" | "<=" | ">" | ">=");
        if !is_comparison {
            self.marks.extend(ids.iter().map(|id| (*id, first)));
        }
        let pieces = match binary.op {
            BinOp::And(_) | BinOp::Or(_) => {
                if has_let(&binary.left) || has_let(&binary.right) {
                    self.refused.insert(first);
                    return;
                }
                let question = if matches!(binary.op, BinOp::And(_)) { "!=" } else { "==" };
                vec![
                    text("({ let __l: bool = "),
                    Piece::Inner(left),
                    Piece::Of(first, format!("; if __l {question} crate::mutant::on({first}) {{ ")),
                    Piece::Inner(right),
                    text(" } else { __l } })"),
                ]
            }
            _ if is_comparison => {
                let mut pieces =
                    vec![text("(match (&("), Piece::Inner(left), text("), &("), Piece::Inner(right)];
                pieces.push(text(")) { (__l, __r) => { if crate::mutant::COVER {"));
                for (id, other) in &mutants {
                    let differs =
                        format!(" crate::mutant::mark({id}, (*__l {other} *__r) != (*__l {sign} *__r));");
                    pieces.push(Piece::Of(*id, differs));
                }
                pieces.push(text(" } match crate::mutant::active() {"));
                for (id, other) in &mutants {
                    pieces.push(Piece::Of(*id, format!(" {id} => *__l {other} *__r,")));
                }
                pieces.push(text(format!(" _ => *__l {sign} *__r }} }} }})")));
                pieces
            }
            _ if sign.ends_with('=') => {
                let mut pieces =
                    vec![text("(match ("), Piece::Inner(right), text(") { __r => { let __p = &mut (")];
                pieces.push(Piece::Inner(left));
                pieces.push(text(format!("); match crate::mutant::at({first}) {{")));
                for (id, other) in &mutants {
                    pieces.push(Piece::Of(*id, format!(" {id} => {{ *__p {other} __r; }}")));
                }
                pieces.push(text(format!(" _ => {{ *__p {sign} __r; }} }} }} }})")));
                pieces
            }
            _ => {
                let mut pieces = vec![text("(match ("), Piece::Inner(left), text(", "), Piece::Inner(right)];
                pieces.push(text(format!(") {{ (__l, __r) => match crate::mutant::at({first}) {{")));
                for (id, other) in &mutants {
                    pieces.push(Piece::Of(*id, format!(" {id} => __l {other} __r,")));
                }
                pieces.push(text(format!(" _ => __l {sign} __r }} }})")));
                pieces
            }
        };
        self.edits.add(all, ids, pieces);
    }

    fn unary(&mut self, unary: &syn::ExprUnary) {
        let operator = bytes(&unary.op);
        let mutants = self.mutants(Genre::UnaryOperator, operator.start);
        let Some(&(id, _)) = mutants.first() else { return };
        let sign = match unary.op {
            UnOp::Neg(_) => "-",
            UnOp::Not(_) => "!",
            _ => return,
        };
        let all = bytes(unary);
        let pieces = vec![
            text("(match ("),
            Piece::Inner(operator.end..all.end),
            text(format!(") {{ __l => if crate::mutant::on({id}) {{ ")),
            Piece::Of(id, "__l".into()),
            text(format!(" }} else {{ {sign}__l }} }})")),
        ];
        self.edits.add(all, vec![id], pieces);
    }

    /// A body's values in its stead. Where the caller does not name the type, there can be but one.
    fn body(&mut self, signature: &syn::Signature, block: &syn::Block) {
        if let syn::ReturnType::Type(_, kind) = &signature.output
            && matches!(kind.as_ref(), syn::Type::ImplTrait(_))
        {
            return;
        }
        let Some(first) = block.stmts.first() else { return };
        let mutants = self.mutants(Genre::FnValue, bytes(first).start);
        if mutants.is_empty() {
            return;
        }
        let ids = mutants.iter().map(|(id, _)| *id).collect();
        let pieces = mutants
            .iter()
            .map(|(id, value)| Piece::Of(*id, format!(" if crate::mutant::on({id}) {{ return {value}; }}")));
        let after = start(block.brace_token.span.open()) + 1;
        self.edits.insert(after, ids, pieces.collect());
    }

    fn arm(&mut self, arm: &syn::Arm) {
        let gone = self.mutants(Genre::MatchArm, bytes(arm).start);
        if let Some(&(id, _)) = gone.first() {
            match &arm.guard {
                Some((_, guard)) => {
                    let range = bytes(guard.as_ref());
                    let pieces = vec![
                        Piece::Of(id, format!("!crate::mutant::on({id}) && (")),
                        Piece::Inner(range.clone()),
                        text(")"),
                    ];
                    self.edits.add(range, vec![id], pieces);
                }
                None => {
                    let guard = Piece::Of(id, format!(" if !crate::mutant::on({id})"));
                    self.edits.insert(bytes(&arm.pat).end, vec![id], vec![guard]);
                }
            }
        }
        let Some((_, guard)) = &arm.guard else { return };
        let range = bytes(guard.as_ref());
        let mutants = self.mutants(Genre::MatchArmGuard, range.start);
        let Some(&(first, _)) = mutants.first() else { return };
        self.marks.extend(mutants.iter().map(|(id, _)| (*id, first)));
        let mut pieces = vec![text(format!("(match crate::mutant::at({first}) {{"))];
        for (id, value) in &mutants {
            pieces.push(Piece::Of(*id, format!(" {id} => {value},")));
        }
        pieces.extend([text(" _ => ("), Piece::Inner(range.clone()), text(") })")]);
        self.edits.add(range, mutants.iter().map(|(id, _)| *id).collect(), pieces);
    }

    fn field(&mut self, structure: &syn::ExprStruct) {
        let Some(rest) = &structure.rest else { return };
        let [path, base] =
            [bytes(&structure.path), bytes(rest.as_ref())].map(|range| &self.source.text[range]);
        for field in &structure.fields {
            let mutants = self.mutants(Genre::StructField, bytes(field).start);
            let (Some(&(id, _)), syn::Member::Named(name)) = (mutants.first(), &field.member) else {
                continue;
            };
            let value = bytes(&field.expr);
            let prefix = if field.colon_token.is_some() { String::new() } else { format!("{name}: ") };
            let pieces = vec![
                text(format!("{prefix}if crate::mutant::on({id}) {{ ")),
                Piece::Of(id, format!("({path} {{ ..{base} }}).{name}")),
                text(" } else { "),
                Piece::Inner(value.clone()),
                text(" }"),
            ];
            self.edits.add(value, vec![id], pieces);
        }
    }

    /// A constant's or static's value.
    fn value(&mut self, name: (&syn::Ident, Span), value: (&syn::Type, &Expr)) {
        if self.constants.makes_lazy(name, value, self.source.path, &mut self.edits) {
            self.visit_expr(value.1);
        }
    }

    /// Notes the mutants of what this machine does not compile; whether it does.
    fn compiled(&mut self, attributes: &[syn::Attribute], range: Range<usize>) -> bool {
        let compiled = attributes
            .iter()
            .filter(|attribute| attribute.path().is_ident("cfg"))
            .all(|attribute| attribute.parse_args::<Meta>().map_or(true, |meta| holds(&meta, self.machine)));
        if !compiled {
            let inside = self.here.iter().filter(|((_, at), _)| range.contains(at));
            self.elsewhere.extend(inside.flat_map(|(_, mutants)| mutants.iter().map(|mutant| mutant.id)));
        }
        compiled
    }
}

/// Whether a condition of `#[cfg(…)]` holds in a test build on this machine.
fn holds(meta: &Meta, machine: &BTreeSet<String>) -> bool {
    let inner = |list: &syn::MetaList| {
        list.parse_args_with(Punctuated::<Meta, Token![,]>::parse_terminated).unwrap_or_default()
    };
    match meta {
        Meta::Path(path) => {
            path.is_ident("test") || path.get_ident().is_some_and(|name| machine.contains(&name.to_string()))
        }
        Meta::NameValue(pair) => {
            let value = quote::ToTokens::to_token_stream(&pair.value).to_string();
            pair.path.get_ident().is_some_and(|name| machine.contains(&format!("{name}={value}")))
        }
        Meta::List(list) if list.path.is_ident("not") => !inner(list).iter().all(|meta| holds(meta, machine)),
        Meta::List(list) if list.path.is_ident("any") => inner(list).iter().any(|meta| holds(meta, machine)),
        Meta::List(list) => inner(list).iter().all(|meta| holds(meta, machine)),
    }
}

impl<'ast> Visit<'ast> for Weaver<'_> {
    fn visit_item(&mut self, item: &'ast syn::Item) {
        let attributes: &[syn::Attribute] = match item {
            syn::Item::Mod(item) => &item.attrs,
            syn::Item::Fn(item) => &item.attrs,
            syn::Item::Impl(item) => &item.attrs,
            _ => &[],
        };
        if self.compiled(attributes, bytes(item)) {
            visit::visit_item(self, item);
        }
    }

    fn visit_item_impl(&mut self, item: &'ast syn::ItemImpl) {
        let outside = std::mem::replace(&mut self.of, constant::own_type(item));
        visit::visit_item_impl(self, item);
        self.of = outside;
    }

    fn visit_item_fn(&mut self, item: &'ast syn::ItemFn) {
        if self.constants.frees(&item.sig, self.of.as_deref(), self.source.path, &mut self.edits) {
            self.body(&item.sig, &item.block);
            visit::visit_item_fn(self, item);
        }
    }

    fn visit_impl_item_fn(&mut self, item: &'ast syn::ImplItemFn) {
        if self.constants.frees(&item.sig, self.of.as_deref(), self.source.path, &mut self.edits) {
            self.body(&item.sig, &item.block);
            visit::visit_impl_item_fn(self, item);
        }
    }

    fn visit_trait_item_fn(&mut self, item: &'ast syn::TraitItemFn) {
        if let Some(block) = &item.default {
            self.body(&item.sig, block);
        }
        visit::visit_trait_item_fn(self, item);
    }

    fn visit_item_const(&mut self, item: &'ast syn::ItemConst) {
        self.value((&item.ident, item.const_token.span), (&item.ty, &item.expr));
    }

    fn visit_item_static(&mut self, item: &'ast syn::ItemStatic) {
        self.value((&item.ident, item.static_token.span), (&item.ty, &item.expr));
    }

    fn visit_impl_item_const(&mut self, _: &'ast syn::ImplItemConst) {}
    fn visit_trait_item_const(&mut self, _: &'ast syn::TraitItemConst) {}
    fn visit_type(&mut self, _: &'ast syn::Type) {}
    fn visit_pat(&mut self, _: &'ast syn::Pat) {}
    fn visit_generics(&mut self, _: &'ast syn::Generics) {}
    fn visit_generic_argument(&mut self, _: &'ast syn::GenericArgument) {}
    fn visit_variant(&mut self, _: &'ast syn::Variant) {}

    fn visit_expr_const(&mut self, block: &'ast syn::ExprConst) {
        self.edits.replace(block.const_token.span.byte_range(), "");
        visit::visit_expr_const(self, block);
    }

    fn visit_expr_repeat(&mut self, repeat: &'ast syn::ExprRepeat) {
        self.visit_expr(&repeat.expr);
    }

    fn visit_expr_binary(&mut self, binary: &'ast syn::ExprBinary) {
        self.binary(binary);
        visit::visit_expr_binary(self, binary);
    }

    fn visit_expr_unary(&mut self, unary: &'ast syn::ExprUnary) {
        self.unary(unary);
        visit::visit_expr_unary(self, unary);
    }

    fn visit_arm(&mut self, arm: &'ast syn::Arm) {
        self.arm(arm);
        visit::visit_arm(self, arm);
    }

    fn visit_expr_struct(&mut self, structure: &'ast syn::ExprStruct) {
        self.field(structure);
        visit::visit_expr_struct(self, structure);
    }

    fn visit_expr_path(&mut self, path: &'ast syn::ExprPath) {
        if path.qself.is_none() && self.constants.is_lazy(&path.path, self.source.path) {
            let range = bytes(path);
            let name = self.source.text[range.clone()].to_owned();
            self.edits.add(range, Vec::new(), vec![text(format!("(*{name})"))]);
        }
    }

    fn visit_macro(&mut self, item: &'ast syn::Macro) {
        // Only for the constants: cargo-mutants changes nothing in there.
        if let Ok(arguments) = item.parse_body_with(Punctuated::<Expr, Token![,]>::parse_terminated) {
            for argument in &arguments {
                self.visit_expr(argument);
            }
        }
    }
}
